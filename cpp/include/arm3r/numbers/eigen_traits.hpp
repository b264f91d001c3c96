// Lets every number type be the scalar of an Eigen matrix, with the costs of a double so that Eigen unrolls alike.
#pragma once

#include <Eigen/Core>

#include "arm3r/numbers/dual.hpp"
#include "arm3r/numbers/expr.hpp"
#include "arm3r/numbers/pack.hpp"

namespace arm3r {

template <class T>
struct EigenTraits : Eigen::NumTraits<double> {
    using Real = T;
    using NonInteger = T;
    using Nested = T;
    enum { RequireInitialization = 1 };
};

}  // namespace arm3r

namespace Eigen {

template <int N>
struct NumTraits<arm3r::Pack<N>> : arm3r::EigenTraits<arm3r::Pack<N>> {};
template <int N>
struct NumTraits<arm3r::Dual<N>> : arm3r::EigenTraits<arm3r::Dual<N>> {};
template <>
struct NumTraits<arm3r::Expr> : arm3r::EigenTraits<arm3r::Expr> {};

// A matrix of these numbers can be combined with a double or a matrix of doubles.
template <class T, class Operation>
    requires std::is_base_of_v<arm3r::EigenTraits<T>, NumTraits<T>>
struct ScalarBinaryOpTraits<T, double, Operation> {
    using ReturnType = T;
};
template <class T, class Operation>
    requires std::is_base_of_v<arm3r::EigenTraits<T>, NumTraits<T>>
struct ScalarBinaryOpTraits<double, T, Operation> {
    using ReturnType = T;
};

}  // namespace Eigen
