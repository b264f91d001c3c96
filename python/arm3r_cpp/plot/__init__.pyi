from ..animation.animate import animate as animate
from ..measured.figure import measured as measured
from .figures import compare as compare
from .figures import force as force
from .figures import lecture as lecture
from .figures import overview as overview
from .figures import show as show
