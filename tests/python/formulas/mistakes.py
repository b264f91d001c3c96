"""Mistakes as students make them, by hand: in which right formula, and what stands where in the place of what.

Single ones have one replacement, pairs two; each text that is replaced stands once in its file, or at its first place.
"""

from __future__ import annotations

from typing import NamedTuple


class Mistakes(NamedTuple):
    file: str
    replaced: tuple[tuple[str, str], ...]


_SINGLE: dict[str, tuple[tuple[str, str], ...]] = {
    "unequal/jacobian_block.py": (
        ("radial @ drho", "tangent @ drho"),
        ("-L2*np.sin(t2 + t3)]])\n    dz", "-L1*np.sin(t2 + t3)]])\n    dz"),
    ),
    "unequal/jacobian_broadcast.py": (
        ("slope = length*", "slope = "),
        ("heading[:, None]*tail[0]", "heading[:, None]*slope[0]"),
        ("-reach*heading[1], reach*heading[0]", "reach*heading[1], reach*heading[0]"),
    ),
    "unequal/jacobian_dh_table.py": (
        ("(0, -PI/2, 0.25)", "(0, PI/4, 0.25)"),
        ("Ti[:3, 2], pe", "Ti[:3, 1], pe"),
        ("(0.8, 0, 0), (0.55, 0, 0)", "(0.55, 0, 0), (0.8, 0, 0)"),
    ),
    "unequal/jacobian_lambdify.py": (
        ("sp.rot_axis3(-q1)", "sp.rot_axis3(q1)"),
        ("p.jacobian([q1, q2, q3])", "p.jacobian([q1, q3, q2])"),
    ),
    "unequal/jacobian_shorthand.py": (
        ("c23, s23 = cos(q[1]+q[2]), sin(q[1]+q[2])", "c23, s23 = cos(q[1]-q[2]), sin(q[1]-q[2])"),
        ("-(A2*c2+A3*c23)]", "-A2*c2+A3*c23]"),
    ),
    "unequal/jacobian_einsum.py": (
        ("ijk,aj,ak->ia", "ijk,ak,aj->ia"),
        ("axes = np.array([k, n, n])", "axes = np.array([k, n, k])"),
        ("- np.sin(t)*k", "+ np.sin(t)*k"),
    ),
    "unequal/jacobian_exponentials.py": (
        ("(1 - np.cos(t))*W @ W", "np.cos(t)*W @ W"),
        ("(np.eye(3) - R) @ p", "R @ p"),
        ("hat(z) @ (tip - o)", "hat(z) @ tip"),
    ),
    "unequal/jacobian_dual.py": (("self.x*other.d + self.d*other.x", "self.x*other.d"),),
    "unequal/jacobian_quaternion.py": (
        ("np.cos(angle/2)", "np.cos(angle)"),
        ("w1*v2 + w2*v1 + np.cross(v1, v2)", "w1*v2 + w2*v1 - np.cross(v1, v2)"),
    ),
    "unequal/jacobian_helpers.py": (
        ("H = A[2]*S(b) + A[3]*S(b, c)", "H = A[2]*S(b) + A[2]*S(b, c)"),
        ("J[2] = [0, -R", "J[2] = [1, -R"),
        ("-S(a)*H, -S(a)*A[3]", "-C(a)*H, -S(a)*A[3]"),
    ),
    "unequal/jacobian_rotation_derivatives.py": (
        ("[[-s, -c, 0], [c, -s, 0], [0, 0, 0]]", "[[-s, -c, 0], [c, -s, 0], [0, 0, 1]]"),
        ("R1 @ R2 @ dRy(q[2]) @ l3", "R1 @ dRy(q[2]) @ l3"),
    ),
    "unequal/jacobian_recursive.py": (
        ("phi = sum(q[1:i + 1])", "phi = sum(q[:i + 1])"),
        ("[(0.55, 2), (0.8, 1)]", "[(0.8, 2), (0.55, 1)]"),
    ),
    "unequal/gravity_rnea.py": (
        ("L[i]*(u[0]*f[1] - u[1]*f[0])", "LC[i]*(u[0]*f[1] - u[1]*f[0])"),
        ("f = f + w", "f = w"),
        ("taus.insert(0, n)", "taus.append(n)"),
    ),
    "unequal/gravity_jacobian_sums.py": (
        ("arms=[0.8, 0.21]", "arms=[0.8, 0.8]"),
        ("-sum(l*np.cos", "sum(l*np.cos"),
    ),
    "unequal/gravity_comprehension.py": (
        ("-W3*0.8*cos(th[0])", "-W2*0.8*cos(th[0])"),
        ("[[0, 0, moments[0][2]]]", "[[0, 0, moments[0][1]]]"),
    ),
    "unequal/gravity_degrees.py": (
        ("cosd(q2_deg + q3_deg)", "cosd(q3_deg)"),
        ("t2 = t3 -", "t2 = t3 +"),
    ),
    "unequal/kinematics_complex.py": (
        ("cmath.exp(-1j*(q2 + q3))", "cmath.exp(-1j*q3)"),
        ("cmath.exp(1j*q1)", "cmath.exp(-1j*q1)"),
        ("0.25 + w.imag", "0.25 - w.imag"),
        ("0.25 + w.imag", "w.imag"),
    ),
    "unequal/kinematics_dh.py": (
        ("T01.dot(T12).dot(T23)", "T01.dot(T23).dot(T12)"),
        ("0, a2*s(q[1])]", "0, a2*c(q[1])]"),
    ),
    "unequal/kinematics_zyx.py": (
        ("[cy*cp, cy*sp*sr", "[cy*sp, cy*sp*sr"),
        ("elbow + 0.55", "0.55"),
    ),
    "unequal/mass_columns.py": (("l2*E2[:, 0], a2*E2[:, 0] + l3*E3[:, 0]", "l2*E2[:, 0], l2*E2[:, 0] + l3*E3[:, 0]"),),
    "unequal/mass_einsum.py": (
        ("np.einsum('b,bj,bk->jk', across, mask, mask)", "np.einsum('b,bj,bk->jk', across, mask, mask)/2"),
        ("np.tril", "np.triu"),
    ),
    "unequal/mass_unit_accelerations.py": (
        ("al3 = al2 + qdd[2]*n", "al3 = qdd[2]*n"),
        (" + 0.043*al3", ""),
    ),
    "unequal/coriolis_christoffel_einsum.py": (("- np.einsum('jki->ijk', D)", "+ np.einsum('jki->ijk', D)"),),
    "unequal/coriolis_differences.py": (("(A - 0.002)*c2**2", "A*c2**2"),),
    "unequal/inverse_lagrange.py": (
        ("+ C*s3*w2**2", "- C*s3*w2**2"),
        ("(dM2*w2 + dM3*w3)*w1", "(dM2*w2 + dM3*w3)"),
    ),
    "unequal/forward_cramer.py": (("(M33*r2 - M23*r3)/det", "(M33*r2 + M23*r3)/det"),),
    "unequal/jacobian_matlabfunction.m": (
        ("t14 = t9+t11", "t14 = t9+t12"),
        ("t6 = q2+q3", "t6 = q2-q3"),
        ("-t2.*t12,-t4.*t12,t13],[3,3]", "-t4.*t12,-t2.*t12,t13],[3,3]"),
    ),
    "unequal/jacobian_loop.m": (
        ("alpha = [-pi/2 0 0]", "alpha = [pi/4 0 0]"),
        ("T{i+1} = T{i}*", "T{i+1} = "),
        ("z = T{i}(1:3,3)", "z = T{i+1}(1:3,3)"),
    ),
    "unequal/gravity_shorthand.m": (("m = [1.3; 2.1]", "m = [2.1; 1.3]"),),
    "unequal/gravity_loop.m": (
        ("for k = j-1:2", "for k = 1:2"),
        ("q(2:k+1)", "q(1:k+1)"),
        ("tau(j) - m(b)", "tau(j) + m(b)"),
    ),
    "unequal/coriolis_matrix.m": (
        ("-b*(qd(2)+qd(3))", "-b*qd(3)"),
        ("-h3*qd(1), b*qd(2), 0", "-h3*qd(1), -b*qd(2), 0"),
    ),
    "unequal/inverse_terms.m": (
        ("M23 = B + C*cos(q3)", "M23 = B + 2*C*cos(q3)"),
        ("(2*qd(2)+qd(3))*qd(3)", "(2*qd(2)+qd(3))"),
    ),
    "unequal/forward_backslash.m": (("M\\(tau - h - G)", "M*(tau - h - G)"),),
    "lecture/jacobian_transposed.m": (("-a(2)*c(2)]", "-a(2)*c(1)]"),),
    "lecture/gravity_sum_of_products.m": (
        ("m2*l2/2", "m2*l3/2"),
        ("-g0*S*C", "-g0*S*S'"),
    ),
    "lecture/gravity_vertical.py": (("p3 = p2 + q[2]", "p3 = q[1] + q[2]"),),
    "lecture/jacobian_unit_arm.py": (("[0, z2, z3]", "[0, z3, z2]"),),
    "lecture/mass_spatial.py": (
        ("I + m*C @ C.T", "I - m*C @ C.T"),
        ("half*R[:, 0]", "a*R[:, 0]"),
    ),
    "unequal/jacobian_tensor.py": (
        ("np.array([p2 + p3, p2 + p3, p3])", "np.array([p2 + p3, p2 + p3, p2])"),
        ("(1 - np.cos(t)) * K @ K", "(1 + np.cos(t)) * K @ K"),
    ),
    "unequal/jacobian_while.py": (("z -= a[i-1]*s(pitch)", "z -= a[i-1]*c(pitch)"),),
    "unequal/jacobian_expm.py": (("-np.cross(w, p)", "np.cross(w, p)"),),
    "unequal/jacobian_matrix.py": (
        ("[0, -0.8*cos(q[1]) - 0.55*cos(b), -0.55*cos(b)]", "[0, -0.8*cos(q[1]) - 0.55*cos(b), -0.55*cos(q[1])]"),
        ("return R*plane", "return R.T*plane"),
    ),
    "unequal/jacobian_modified_dh.py": (
        ("st*ca, ct*ca", "st*ca, ct*sa"),
        ("alpha=-np.pi/2", "alpha=np.pi/4"),
    ),
    "unequal/gravity_levers.py": (
        ("for k in range(j, i))", "for k in range(i))"),
        ("ARM[k].length", "ARM[k].com"),
    ),
    "unequal/gravity_match.py": (
        ("M[2]*LC[2] + M[3]*0.8", "M[2]*LC[2] + M[2]*0.8"),
        ("return 0.0", "return g"),
    ),
    "unequal/gravity_virtual_work.py": (("((1.3, J2), (2.1, J3))", "((1.3, J3), (2.1, J2))"),),
    "unequal/gravity_links_from_1.py": (
        ("m1*lc1 + m2*l1", "m1*lc1 + m1*l1"),
        ("np.cos(th2) + g2", "np.cos(th2) - g2"),
    ),
    "unequal/kinematics_quaternions.py": (
        ("w*c - x*d + y*a + z*b", "w*c + x*d + y*a + z*b"),
        ("c = mul(b, turn(1, q[2]))", "c = mul(a, turn(1, q[2]))"),
    ),
    "unequal/kinematics_polar.py": (
        ("base - w.imag", "base + w.real"),
        ("fore*cmath.exp(1j*(theta2 + theta3))", "fore*cmath.exp(1j*theta2 + theta3)"),
    ),
    "unequal/kinematics_rotations.py": (
        ("T[2, [0, 2]] = -np.sin(t), np.cos(t)", "T[2, [0, 2]] = np.sin(t), np.cos(t)"),
        ("trans(x=0.8)", "trans(z=0.8)"),
        ("roty(q[2]), trans(0.55)", "trans(0.55), roty(q[2])"),
    ),
    "unequal/mass_energy.py": (
        ("a*np.cos(t[0]) + lc[1]*np.cos(t[1])])\n    xd", "a*np.cos(t[0]) - lc[1]*np.cos(t[1])])\n    xd"),
    ),
    "unequal/jacobian_cached.py": (("np.c_[J1, J2, J3]", "np.c_[J1, J3, J2]"),),
    "unequal/jacobian_handles.m": (("Rz(q1)*0.55*du(q2 + q3)]", "Rz(q1)*0.55*u(q2 + q3)]"),),
    "unequal/gravity_levers.m": (
        ("-g*(m*x)", "-g*(m*lc)"),
        ("cos(phi(2))];", "cos(phi(1))];"),
    ),
    "unequal/mass_rotations.m": (
        ("Jw3 = [k n n]", "Jw3 = [k n zeros(3,1)]"),
        ("2.1*(Jv3'*Jv3)", "2.1*(Jv3*Jv3')"),
    ),
    "unequal/coriolis_complex_step.py": (("+ dM[j][i, k]", "+ dM[j][k, i]/2"),),
    "unequal/kinematics_local.m": (("roty3(q(3))*[0.55", "roty3(q(2))*[0.55"),),
    "unequal/jacobian_structure.m": (("p.a2*s2 + p.a3*s23", "p.a2*s2 - p.a3*s23"),),
    "unequal/jacobian_conditions.m": (
        ("max(j-1, 1):2", "j:2"),
        ("q(2:k+1)", "q(1:k+1)"),
        ("sin(q(1))*sin(t); cos(t)]", "sin(q(1))*sin(t); cos(q(1))]"),
    ),
    "unequal/gravity_by_cases.m": (
        ("if sin(q(3)) >= 0", "if sin(q(3)) <= 0"),
        ("q(2) - inner", "q(2) + inner"),
    ),
}
_PAIRS: dict[str, tuple[tuple[tuple[str, str], tuple[str, str]], ...]] = {
    "unequal/jacobian_block.py": (
        (("[-np.sin(t1), np.cos(t1)]", "[np.sin(t1), np.cos(t1)]"), ("[[-L1*np.cos(t2)", "[[-L1*np.sin(t2)")),
        (("+ L2*np.cos(t2 + t3)\n", "+ L2*np.cos(t3)\n"), ("-L2*np.cos(t2 + t3)]])", "L2*np.cos(t2 + t3)]])")),
    ),
    "unequal/jacobian_shorthand.py": (
        (("[-s1*(A2*c2+A3*c23)", "[s1*(A2*c2+A3*c23)"), ("-A3*c23]", "-A2*c23]")),
        (("-c1*(A2*s2+A3*s23)", "-c1*(A2*s2+A3*s2)"), ("-s1*(A2*s2+A3*s23)", "-s1*(A2*c2+A3*s23)")),
    ),
    "unequal/jacobian_helpers.py": (
        (("H = A[2]*S(b)", "H = A[3]*S(b)"), ("J[2] = [0, -R", "J[2] = [0, R")),
        (("-S(a)*R", "S(a)*R"), ("-C(a)*A[3]*S(b, c)", "-C(a)*A[3]*S(c)")),
    ),
    "unequal/jacobian_einsum.py": (
        (("- np.sin(t)*k", "+ np.sin(t)*k"), ("0.55*dirs[1]])", "0.8*dirs[1]])")),
    ),
    "unequal/gravity_complex_step.py": (
        (("z2 = -0.37", "z2 = -0.8"), ("0.21*np.sin(q[1] + q[2])", "0.21*np.sin(q[2])")),
    ),
    "unequal/gravity_rnea.py": ((("-M[i]*g", "M[i]*g"), ("pitch = [q[1], q[1] + q[2]]", "pitch = [q[1], q[2]]")),),
    "unequal/kinematics_dh.py": (
        (("[0, -1, 0, d1]", "[0, 1, 0, d1]"), ("0, a3*c(q[2])]", "0, a2*c(q[2])]")),
        (("0, a2*s(q[1])]", "0, a2*c(q[1])]"), ("0, a3*s(q[2])]", "0, a3*c(q[2])]")),
    ),
    "unequal/kinematics_complex.py": ((("0.8*cmath", "0.55*cmath"), ("0.25 + w.imag", "w.imag")),),
    "unequal/mass_columns.py": ((("l2*E2[:, 0], a2", "a2*E2[:, 0], a2"), ("m3*Jv3.T", "m2*Jv3.T")),),
    "unequal/coriolis_christoffel_einsum.py": (
        (("D[1, 1, 2] = -2*C", "D[1, 1, 2] = -C"), ("D[0, 0, 2] = -2*B", "D[0, 0, 2] = -B")),
    ),
    "unequal/inverse_lagrange.py": (
        (("- dM2*w1**2/2", "- dM2*w1**2"), ("t3 -= g*2.1*0.21*c23", "t3 -= g*2.1*0.21*c2")),
        (("+ C*s3*w2**2", "- C*s3*w2**2"), ("(2*w2*w3 + w3**2)", "(2*w2*w3)")),
    ),
    "unequal/jacobian_rotations.m": (
        (("r2 = a2*R2(:,1) + r3", "r2 = a2*R2(:,1)"), ("r3 = a3*R3(:,1)", "r3 = a2*R3(:,1)")),
    ),
    "unequal/kinematics_handles.m": ((("Ry(q(2)+q(3))", "Ry(q(3))"), ("[0; 0; 0.25]", "[0; 0; 0]")),),
    "unequal/gravity_shorthand.m": ((("-0.21*c23]", "-0.21*c2]"), ("g = 9.80665", "g = 9.81")),),
    "unequal/coriolis_matrix.m": ((("-b*(qd(2)+qd(3))", "-b*qd(3)"), ("- k*c2*s23", "+ k*c2*s23")),),
    "lecture/gravity_vertical.py": ((("a3/2*np.sin", "a3*np.sin"), ("-m2*g*a2/2", "-m2*g*a2")),),
    "lecture/gravity_sum_of_products.m": ((("m2*l2/2", "m2*l2"), ("-g0*S(2)*C(2)", "g0*S(2)*C(2)")),),
    "lecture/jacobian_transposed.m": ((("c1*(a*c), 0", "s1*(a*c), 0"), ("-a(2)*c(2)]", "a(2)*c(2)]")),),
}  # fmt: skip


def singles() -> list[Mistakes]:
    return [Mistakes(file, (one,)) for file, ones in _SINGLE.items() for one in ones]


def pairs() -> list[Mistakes]:
    return [Mistakes(file, both) for file, ones in _PAIRS.items() for both in ones]


def wrong_text(text: str, mistakes: Mistakes) -> str:
    """The text with the mistakes in it."""
    for old, new in mistakes.replaced:
        assert old in text, (mistakes.file, old)
        text = text.replace(old, new, 1)
    return text
