"""Many communication steps at once: inputs along straight lines, outputs after each step.

A call from Python takes longer than a step of the component. Here it steps by itself (`relayContactFollow` of its
library), and Python may do something else meanwhile.
"""

from collections.abc import Mapping, Sequence
from ctypes import c_int, c_size_t, c_void_p
from typing import TYPE_CHECKING

import numpy as np
from fmpy.fmi1 import FMICallException
from numpy.typing import ArrayLike

from relay_contact.files import RelayContactError

# The component steps by this.
if TYPE_CHECKING:
    from relay_contact.component import Array, Contact

FOLLOW = "relayContactFollow"
SOME = (c_void_p, c_size_t)


def drive(
    contact: "Contact", time: ArrayLike, courses: Mapping[str, ArrayLike], watched: Sequence[str] = ()
) -> dict[str, "Array"]:
    """Have inputs follow straight lines between points of time, a step each; return what is watched after each step.

    A time given twice is a jump. The first time is that which the contact has reached.
    """
    times = np.ascontiguousarray(time, dtype=np.float64)
    given = np.zeros((len(times), len(courses)))
    for column, course in enumerate(courses.values()):
        given[:, column] = course
    inputs, outputs = numbers(contact, list(courses)), numbers(contact, watched)
    rows = np.zeros((max(0, len(times) - 1), len(watched)))
    try:
        # A new object, with types of its own, as other threads have theirs.
        follow = contact.fmu.dll[FOLLOW]
    except AttributeError as error:
        raise RelayContactError(f"{contact.component.path} is older than this package: it has no {FOLLOW}") from error
    follow.argtypes, follow.restype = (c_void_p, *SOME, *SOME, c_void_p, *SOME, c_void_p), c_int
    status = follow(
        contact.fmu.component, times.ctypes.data, len(times), inputs.ctypes.data, len(inputs), given.ctypes.data,
        outputs.ctypes.data, len(outputs), rows.ctypes.data,
    )  # fmt: skip
    # Of OK and warning, 0 and 1.
    if status > 1:
        raise FMICallException(function=FOLLOW, status=status)
    contact.tell()
    taken = np.count_nonzero(np.diff(times))
    return {name: rows[:taken, column] for column, name in enumerate(watched)}


def numbers(contact: "Contact", names: Sequence[str]) -> "np.ndarray[tuple[int], np.dtype[np.uint32]]":
    """Return the numbers by which the component knows its variables, as C has them."""
    return np.array(contact.references(*names), dtype=np.uint32)
