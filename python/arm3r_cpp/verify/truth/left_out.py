"""What a formula of a scenario's arm may have left out, as keys of the scenario that are zero then."""

from __future__ import annotations

from ..kinds import Kind

_PLACES: dict[str, tuple[str, ...]] = {"the height of joint 2 above the base frame is left out": ("arm.base_height",)}
_MASSES: dict[str, tuple[str, ...]] = {"the payload is left out": ("arm.payload.mass",)}
_INERTIAS = {
    "the armature is left out": ("arm.armature",),
    "the rotors are left out": tuple(f"arm.rotor{joint}.inertia" for joint in (1, 2, 3)),
}
_RESISTANCES = {"the damping is left out": ("arm.damping",), "the friction is left out": ("arm.friction",)}


def left_out(kind: Kind) -> dict[str, tuple[str, ...]]:
    """The keys of what formulas of a kind depend on, by the words for a formula without it."""
    if not kind.needs_masses:
        return _PLACES
    found = _MASSES | (_INERTIAS if kind.depends_on_inertia else {})
    return found | (_RESISTANCES if kind.depends_on_inertia and kind.depends_on_gravity else {})
