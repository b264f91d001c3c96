import math
from dataclasses import dataclass, field

@dataclass
class Link:
    mass: float
    length: float
    child: "Link | None" = None
    com: float = field(init=False)

    def __post_init__(self):
        self.com = self.length / 2

    def weight(self):
        return self.mass + (self.child.weight() if self.child else 0)

ARM = Link(0.785, 1.0, Link(0.785, 1.0))

def torques(link, angle, rest, g=9.80665):
    angle += rest[0]
    own = -link.mass*g*link.com*math.cos(angle)
    if link.child is None:
        return [own]
    later = torques(link.child, angle, rest[1:], g)
    return [own - link.child.weight()*g*link.length*math.cos(angle) + later[0], *later]

def gravity(q):
    return [0.0, *torques(ARM, 0.0, list(q[1:]))]
