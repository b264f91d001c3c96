#pragma once
// The same arm in other programs, behind plain numbers: each peer is a library of its own, compiled as suits it best,
// and includes nothing of arm3r but this file. Slide convention.

#include <memory>

namespace peers {

struct Body {
    double length, mass;  // m, kg
    double com[3];        // m from the joint: along the link, across in its plane, along the joint
    double inertia[3];    // kg m^2 about the centre of mass, along these axes
    double products[3];   // kg m^2, xy, xz, yz of the tensor
};

struct Numbers {
    double base_height;              // m
    double shoulder_offset, offset;  // m: of joint 2 from axis 1, of link 3 along the axis of joint 2
    double turret_inertia;           // kg m^2 about the vertical
    Body link2, link3;
    double gravity[3];  // m/s^2
};

class [[gnu::visibility("default")]] Pinocchio {
public:
    // Version, compiler and flags. No std::string: its code would be compiled for this processor too, and valgrind, which
    // knows fewer instructions, could not even list the jobs.
    static const char* build();
    explicit Pinocchio(const Numbers& numbers);
    ~Pinocchio();
    void forward_dynamics(const double* q, const double* qd, const double* tau, double* qdd);

private:
    struct Implementation;
    std::unique_ptr<Implementation> in_;
};

class [[gnu::visibility("default")]] Mujoco {
public:
    static const char* build();
    Mujoco(const Numbers& numbers, double step);
    ~Mujoco();
    void forward_dynamics(const double* q, const double* qd, const double* tau, double* qdd);
    void start(const double* q, const double* qd);
    void advance(int steps);  // by RK4
    const double* q() const;
    const double* qd() const;

private:
    struct Implementation;
    std::unique_ptr<Implementation> in_;
};

// Generated for the lecture's arm alone.
class [[gnu::visibility("default")]] Casadi {
public:
    static const char* build();
    // pushed: compensated, with the wall; else in free fall.
    Casadi(double step, bool pushed) : step_(step), pushed_(pushed) {}
    void forward_dynamics(const double* q, const double* qd, const double* tau, double* qdd);
    void start(const double* q, const double* qd);
    void advance(int steps);  // by RK4
    const double* q() const { return y_; }
    const double* qd() const { return y_ + 3; }

private:
    double step_, t_, y_[6];
    bool pushed_;
};

}  // namespace peers
