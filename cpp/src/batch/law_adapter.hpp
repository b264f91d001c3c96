#pragma once
// A law of the user's in C, as the sampled controller calls it.

#include <cmath>

#include "base/callback.hpp"
#include "control/controller_view.hpp"

namespace arm3r {

class LawAdapter {
public:
    LawAdapter(arm3r_law function, void* user, const Setup& setup)
        : function_(function), user_(user), view_(setup), convention_(setup.convention) {
        state_.struct_size = sizeof state_;
    }
    LawAdapter(const LawAdapter&) = delete;
    LawAdapter& operator=(const LawAdapter&) = delete;

    // It is valid as long as this object is.
    UserLaw user_law() { return {call, this, convention_}; }

private:
    static int call(void* self, double tick, const GroundTruth& truth, const Measurement<double>& sensed,
                    const ControllerState<double>& controller_state, Vec3<double>& tau) {
        LawAdapter& law = *static_cast<LawAdapter*>(self);
        law.view_.fill_state(tick, truth, sensed, controller_state, law.state_);
        double caller[3] = {NAN, NAN, NAN};
        const int32_t status = call_back(law.function_, law.user_, &law.state_, caller);
        tau = law.view_.torque(caller);
        return status;
    }

    arm3r_law function_;
    void* user_;
    LawView view_;
    JointConvention convention_;
    arm3r_law_state state_{};
};

}  // namespace arm3r
