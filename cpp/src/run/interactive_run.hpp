#pragma once
// A run that stops at each sample of its controller until advance() is called. A copy continues as the original would,
// bit for bit.

#include <memory>

#include "record/run_data.hpp"

namespace arm3r {

class InteractiveRun {
public:
    virtual ~InteractiveRun() = default;

    virtual bool is_over() const = 0;
    // Advances from the present sample, or from the start, to the next one or to the end of the run.
    virtual void advance() = 0;
    virtual void set_user_law(const UserLaw& law) = 0;
    // Calls a law as the present sample would, without an effect on the run.
    virtual void preview(const UserLaw& law) const = 0;
    virtual std::unique_ptr<InteractiveRun> copy() const = 0;
    // A copy of the run up to now; and the run itself, which is then over.
    virtual Run snapshot() const = 0;
    virtual Run conclude() = 0;

protected:
    InteractiveRun() = default;
    InteractiveRun(const InteractiveRun&) = default;
    InteractiveRun& operator=(const InteractiveRun&) = delete;
};

}  // namespace arm3r
