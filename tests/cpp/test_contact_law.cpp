
#include "arm3r/model/contact.hpp"
#include "arm3r/numbers/dual.hpp"
#include "check.hpp"
#include "fixtures.hpp"

namespace arm3r {

// The force at an indentation, whatever moves.
TEST_SUITE(contact_law)

static Wall<double> oblique_wall() {
    Params params;
    return make_setup(params.set("wall", 1).set("wall.normal", {-1, 0.4, 0.3})).plant.wall;
}

// A wall that does not turn.
template <class T>
static ContactForce<T> force_of(const Wall<double>& wall, const Contact<double>& contact, const Indentation<T>& in,
                                Clamping clamping) {
    return contact_force(wall, no_wall<T>(), contact, in, clamping);
}

static Contact<double> contact_of(ContactLaw law, double stiffness) {
    Contact<double> contact{};
    contact.law = law;
    contact.stiffness = {stiffness, 0, 0};
    contact.slip_velocity = 1e-3;
    return contact;
}

static Contact<double> kelvin_voigt(double damping) {
    Contact<double> contact = contact_of(ContactLaw::kelvin_voigt, 1234);
    contact.damping = damping;
    return contact;
}

static Contact<double> hunt_crossley(double exponent, double dissipation) {
    Contact<double> contact = contact_of(ContactLaw::hunt_crossley, 1234);
    contact.exponent = exponent;
    contact.dissipation = dissipation;
    return contact;
}

static Contact<double> rubbing(Contact<double> contact, double friction) {
    contact.has_friction = true;
    contact.friction = friction;
    return contact;
}

static const Indentation<double> pressing{0.003, 0.1, 0.2, -0.3, 0.4, -0.5}, leaving{0.003, -0.7, 0.2, -0.3, 0.4, -0.5};

static Vec3<double> along(const Wall<double>& wall, double n, double e1, double e2) {
    return n * wall.n + e1 * wall.e1 + e2 * wall.e2;
}

TEST_CASE(each_law_pushes_along_the_normal_as_its_formula_says) {
    const Wall<double> wall = oblique_wall();
    const auto check = [&](const Contact<double>& contact, double normal, double stored) {
        const ContactForce<double> force = force_of(wall, contact, pressing, Clamping::smooth);
        CHECK(std::abs(force.normal / normal - 1) <= 1e-15);
        CHECK(std::abs(force.stored / stored - 1) <= 1e-15);
        CHECK(distance(force.on_tip, along(wall, normal, 0, 0)) <= 1e-15 * normal);
    };
    const double d = 0.003, rate = 0.1;
    check(contact_of(ContactLaw::spring, 1234), 1234 * d, 617 * d * d);
    check(kelvin_voigt(5), 1234 * d + 5 * rate, 617 * d * d);
    for (const double p : {1.0, 1.5, 2.2, 3.0})
        check(hunt_crossley(p, 0.8), 1234 * std::pow(d, p) * (1 + 0.8 * rate), 1234 * std::pow(d, p + 1) / (p + 1));
}

// The lecture's K_E (x - x_E), axis by axis.
TEST_CASE(a_diagonal_stiffness_is_the_lectures_force_on_the_wall) {
    Params params;
    const Wall<double> wall = make_setup(params.set("wall", 1)).plant.wall;
    Contact<double> diagonal = contact_of(ContactLaw::diagonal, 0);
    diagonal.stiffness = {1000, 200, 30};
    const WallState<double> state = wall_at(wall, 1.0);
    const Vec3<double> x = state.position + Vec3<double>(0.002, 0.05, -0.07);
    const ContactForce<double> force =
        force_of(wall, diagonal, indentation(wall, state, x, Vec3<double>(0, 0, 0)), Clamping::smooth);
    CHECK(distance(-force.on_tip, Vec3<double>(1000 * 0.002, 200 * 0.05, 30 * -0.07)) <= 1e-12);
    CHECK(std::abs(force.stored - 0.5 * (1000 * 4e-6 + 200 * 0.0025 + 30 * 0.0049)) <= 1e-15);
}

// The change of the stored energy with depth and place on the plate is the work of the force.
TEST_CASE(springs_are_conservative) {
    Contact<double> diagonal = contact_of(ContactLaw::diagonal, 1234);
    diagonal.stiffness = {1234, 200, 30};
    for (const Contact<double>& contact : {contact_of(ContactLaw::spring, 1234), kelvin_voigt(5),
                                           hunt_crossley(1.5, 0.8), hunt_crossley(3, 0.8), diagonal}) {
        using D = Dual<3>;
        const Indentation<D> in{D::variable(0.003, 0), D(0.0), D::variable(0.2, 1),
                                D::variable(-0.3, 2),  D(0.4), D(-0.5)};
        const Wall<double> wall = oblique_wall();
        const ContactForce<D> force = force_of(wall, contact, in, Clamping::smooth);
        const Vec3<double> on_tip(force.on_tip[0].number, force.on_tip[1].number, force.on_tip[2].number);
        CHECK(std::abs(force.stored.slope[0] - wall.n.dot(on_tip)) <= 1e-14);
        CHECK(std::abs(force.stored.slope[1] + wall.e1.dot(on_tip)) <= 1e-13);
        CHECK(std::abs(force.stored.slope[2] + wall.e2.dot(on_tip)) <= 1e-13);
    }
}

TEST_CASE(friction_opposes_the_slip_with_its_share_of_the_normal_force) {
    const Wall<double> wall = oblique_wall();
    const double speed = std::hypot(0.4, 0.5, 1e-3);
    for (const Contact<double>& contact :
         {contact_of(ContactLaw::spring, 1234), kelvin_voigt(5), hunt_crossley(1.5, 0.8)}) {
        const ContactForce<double> smooth = force_of(wall, contact, pressing, Clamping::smooth),
                                   rough = force_of(wall, rubbing(contact, 0.3), pressing, Clamping::smooth);
        const Vec3<double> drag = rough.on_tip - smooth.on_tip;
        const double share = 0.3 * smooth.normal / speed;
        CHECK(distance(drag, along(wall, 0, -share * 0.4, share * 0.5)) <= 1e-14);
        CHECK(std::abs((rough.dissipated - smooth.dissipated) - share * (0.16 + 0.25)) <= 1e-14);
        CHECK(rough.normal == smooth.normal);
    }
}

// Whatever goes in along the normal and not into the spring is heat, and never less than none.
TEST_CASE(a_contact_that_only_pushes_never_gives_energy) {
    const Wall<double> wall = oblique_wall();
    Random random(33);
    int let_go = 0;
    for (int i = 0; i < 2000; ++i) {
        const Contact<double> laws[] = {kelvin_voigt(random.in(0, 50)),
                                        hunt_crossley(random.in(1, 3), random.in(0, 9))};
        const Contact<double> contact = rubbing(laws[i % 2], random.in(0, 1));
        const Indentation<double> in{random.in(0, 0.01), random.in(-1, 1), 0, 0, random.in(-1, 1), random.in(-1, 1)};
        const NormalForce<double> free = normal_force_law(contact, in);
        for (const Clamping clamping : {Clamping::clamped, Clamping::released}) {
            const ContactForce<double> force = force_of(wall, contact, in, clamping);
            const bool pushes = clamping == Clamping::clamped && free.total > 0;
            CHECK(force.normal == (pushes ? free.total : 0));
            const double into_wall = -force.on_tip.dot(along(wall, -in.rate, in.slip1, in.slip2));
            const double into_spring = free.elastic * in.rate;
            CHECK(std::abs(force.dissipated - (into_wall - into_spring)) <= 1e-12);
            if (pushes || in.rate < 0) CHECK(force.dissipated >= 0);
            let_go += clamping == Clamping::clamped && !pushes;
        }
        CHECK((free.release < 0) == (free.total < 0));
        CHECK(normal_force(contact, in) == std::max(0.0, free.total));
    }
    CHECK(let_go > 100);
}

TEST_CASE(a_law_may_be_continued_smoothly_beyond_its_end) {
    for (const Contact<double>& contact : {kelvin_voigt(5), hunt_crossley(1, 0.8), hunt_crossley(1.5, 0.8)}) {
        const auto slope_at = [&](double depth) {
            const Indentation<Dual<1>> in{Dual<1>::variable(depth, 0), -2.0, 0.0, 0.0, 0.0, 0.0};
            return normal_force_law(contact, in).total.slope[0];
        };
        for (const double depth : {-1e-6, 0.0, 1e-6}) CHECK(std::isfinite(slope_at(depth)));
        CHECK(std::abs(slope_at(1e-12) - slope_at(-1e-12)) <= 1e-9);
        CHECK(normal_force(contact, Indentation<double>{-1e-6, 0, 0, 0, 0, 0}) == 0);
    }
}

TEST_SUITE_END()

}  // namespace arm3r
