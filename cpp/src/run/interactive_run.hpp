#pragma once
// A run that stands at each sample of its controller until it is told to go on. A copy goes on as the original would, bit
// for bit.

#include <memory>

#include "record/run_data.hpp"

namespace arm3r {

class Stepwise {
public:
    virtual ~Stepwise() = default;

    virtual bool is_over() const = 0;
    // From the sample where it stands, or from the start, to the next one or to the end of the run.
    virtual void go_on() = 0;
    virtual void use(const UserLaw& law) = 0;
    // Calls a law as the present sample would, to no effect.
    virtual void show(const UserLaw& law) const = 0;
    virtual std::unique_ptr<Stepwise> copy() const = 0;
    // The run as it is now; and as it is, but it is over then.
    virtual Run so_far() const = 0;
    virtual Run conclude() = 0;

protected:
    Stepwise() = default;
    Stepwise(const Stepwise&) = default;
    Stepwise& operator=(const Stepwise&) = delete;
};

}  // namespace arm3r
