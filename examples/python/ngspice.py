"""The circuit of circuit.py in ngspice, through its shared library.

Each communication step is one `tran ... uic` analysis with the states as initial conditions, so that the integrator of
ngspice restarts after every jump of the contact's conductance. (One analysis with `stop`, `alter` and `resume` misses
stops in ngspice 39.)
"""

import contextlib
import ctypes
import ctypes.util
from collections import deque

import numpy as np

from circuit import Circuit, Course, State
from relay_contact import Array

INNER_STEP, RELATIVE_TOLERANCE = 1e-7, 1e-7  # s, longest; 1
LIBRARIES = ["libngspice.so.0", "libngspice.so", "libngspice.0.dylib", "libngspice.dylib", "ngspice.dll"]
LIBRARIES += ["libngspice-0.dll", "/opt/homebrew/lib/libngspice.dylib"]


class Vector(ctypes.Structure):
    """A result of ngspice, as its shared library declares it."""

    _fields_ = [("name", ctypes.c_char_p), ("type", ctypes.c_int), ("flags", ctypes.c_short)]
    _fields_ += [("real", ctypes.POINTER(ctypes.c_double)), ("complex", ctypes.c_void_p), ("length", ctypes.c_int)]


def load_library() -> ctypes.CDLL:
    """Load ngspice's shared library; `OSError` if there is none."""
    for name in [ctypes.util.find_library("ngspice"), *LIBRARIES]:
        with contextlib.suppress(OSError):
            if name:
                return ctypes.CDLL(name)
    raise OSError("ngspice's shared library is missing")


class NgSpice:
    """ngspice through its shared library."""

    def __init__(self, circuit: Circuit) -> None:
        """Load the library and the circuit."""
        self.library = load_library()
        self.library.ngGet_Vec_Info.restype = ctypes.POINTER(Vector)
        self.said: deque[str] = deque(maxlen=10)
        # ngspice keeps these two functions: they must live as long as this object.
        number, pointer = ctypes.c_int, ctypes.c_void_p
        self.print = ctypes.CFUNCTYPE(number, ctypes.c_char_p, number, pointer)(self.hear)
        self.quit = ctypes.CFUNCTYPE(number, number, ctypes.c_bool, ctypes.c_bool, number, pointer)(lambda *_: 0)
        self.library.ngSpice_Init(self.print, None, self.quit, None, None, None, None)
        lines = f"""relay contact
            V1 supply 0 {circuit.supply}
            R1 supply coil {circuit.load}
            L1 coil contact {circuit.inductance} ic=0
            RC contact 0 1
            RQ contact quench {circuit.quench}
            CQ quench 0 {circuit.capacitance} ic=0
            .options method=trap reltol={RELATIVE_TOLERANCE} abstol=1e-13 vntol=1e-10
            .end""".splitlines()
        netlist = (ctypes.c_char_p * (len(lines) + 1))(*[line.strip().encode() for line in lines], None)
        if self.library.ngSpice_Circ(netlist):
            raise RuntimeError(f"ngspice refused the circuit: {' / '.join(self.said)}")

    def hear(self, text: bytes, _library: int, _user: object) -> int:
        """Keep the messages of ngspice, for errors."""
        self.said.append(text.decode(errors="replace"))
        return 0

    def command(self, text: str) -> None:
        """Execute a command of ngspice."""
        if self.library.ngSpice_Command(text.encode()):
            raise RuntimeError(f"ngspice refused `{text}`: {' / '.join(self.said)}")

    def result(self, name: str) -> Array:
        """Give a vector of the last analysis."""
        vector = self.library.ngGet_Vec_Info(name.encode())
        if not vector:
            raise RuntimeError(f"ngspice gave no {name}: {' / '.join(self.said)}")
        return np.ctypeslib.as_array(vector.contents.real, (vector.contents.length,)).copy()

    def advance(self, start: State, conductance: float, step: float) -> Course:
        """Simulate a communication step."""
        inner = min(INNER_STEP, step / 10)
        for name, value in (("RC", 1 / conductance), ("@L1[ic]", start[0]), ("@CQ[ic]", start[1])):
            self.command(f"alter {name} = {value!r}")
        self.command(f"tran {inner!r} {step!r} 0 {inner!r} uic")
        # The initial state of `uic` is not a result, or not in every version.
        late = self.result("time") > 0
        time = np.append(0.0, self.result("time")[late])
        current = np.append(start[0], self.result("l1#branch")[late])
        capacitor = np.append(start[1], self.result("quench")[late])
        self.command("destroy all")
        if not abs(time[-1] - step) < 1e-9 * step:
            raise RuntimeError(f"ngspice stopped {time[-1]} s into a step of {step} s: {' / '.join(self.said)}")
        return Course(time, current, capacitor)
