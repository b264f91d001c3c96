import numpy as np
from abc import ABC, abstractmethod
class Base(ABC):
    @abstractmethod
    def fk(self, q): ...
    def jacobian(self, q):
        h = 1e-6
        return np.array([(self.fk(q + h*e) - self.fk(q - h*e))/(2*h) for e in np.eye(3)]).T
class ThreeR(Base):
    def fk(self, q):
        r = np.cos(q[1]) + np.cos(q[1]+q[2])
        return np.array([np.cos(q[0])*r, np.sin(q[0])*r, np.sin(q[1]) + np.sin(q[1]+q[2])])
