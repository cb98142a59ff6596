"""Many communication steps at once: inputs along straight lines, outputs after each step.

FMPy's wrappers log and convert, which takes longer than a step of the component. Here its C functions are called
directly, with addresses in arrays of what is set and what is read.
"""

from collections.abc import Mapping, Sequence
from ctypes import c_double, c_int, c_size_t, c_void_p
from typing import TYPE_CHECKING, Any

import numpy as np
from fmpy.fmi1 import FMICallException

# The component steps by this.
if TYPE_CHECKING:
    from relay_contact.component import Array, Contact

ADDRESSES = (c_void_p, c_void_p, c_size_t, c_void_p)
READ = {"Real": np.float64, "Integer": np.int32, "Enumeration": np.int32, "Boolean": np.int32}
"""Numbers of C by the type of a variable."""


def drive(
    contact: "Contact", time: "Array", courses: Mapping[str, "Array"], watched: Sequence[str] = ()
) -> dict[str, "Array"]:
    """Have inputs follow straight lines between points of time, a step each; return what is watched after each step.

    A time given twice is a jump. The first time is that which the contact has reached.
    """
    lengths = np.diff(time)
    steps = np.flatnonzero(lengths > 0)
    lengths = lengths[steps]
    course = np.column_stack([np.asarray(each, dtype=float) for each in courses.values()] or [np.zeros((len(time), 0))])
    begin = np.ascontiguousarray(course[steps])
    slope = np.ascontiguousarray((course[steps + 1] - begin) / lengths[:, None])
    set_real, set_slope = function(contact, "SetReal", *ADDRESSES), function(
        contact, "SetRealInputDerivatives", *ADDRESSES[:3], c_void_p, c_void_p
    )  # fmt: skip
    do_step = function(contact, "DoStep", c_void_p, c_double, c_double, c_int)
    instance, inputs, count = contact.fmu.component, numbers(contact, list(courses)), len(courses)
    orders = np.ones(count, dtype=np.int32)
    at, value, change, stride = inputs.ctypes.data, begin.ctypes.data, slope.ctypes.data, begin.strides[0]
    order = orders.ctypes.data
    readers = [reader(contact, kind, watched, len(steps)) for kind in READ]
    reading = [(get, names.ctypes.data, len(names), rows.ctypes.data, rows.strides[0])
               for get, names, rows, _ in readers if len(names)]  # fmt: skip
    for number, (now, length) in enumerate(zip(time[:-1][steps].tolist(), lengths.tolist(), strict=True)):
        status = do = 0
        if count:
            status = set_real(instance, at, count, value + number * stride)
            status |= set_slope(instance, at, count, order, change + number * stride)
        do = do_step(instance, now, length, 1)
        # Of OK and warning, 0 and 1.
        if (status | do) > 1:
            raise FMICallException(function="fmi2DoStep", status=status | do)
        for get, names, size, rows, width in reading:
            get(instance, names, size, rows + number * width)
    contact.tell()
    return {name: rows[:, column] for _, _, rows, own in readers for column, name in enumerate(own)}


def function(contact: "Contact", name: str, *types: Any) -> Any:  # noqa: ANN401
    """Return a function of the component with the types of its arguments."""
    # A new object for each name, as FMPy's has types of its own.
    found = contact.fmu.dll[f"fmi2{name}"]
    found.argtypes, found.restype = types, c_int
    return found


def numbers(contact: "Contact", names: Sequence[str]) -> Any:  # noqa: ANN401
    """Return the numbers by which the component knows its variables, as C has them."""
    return np.array(contact.references(*names), dtype=np.uint32)


def reader(contact: "Contact", kind: str, watched: Sequence[str], count: int) -> tuple[Any, Any, Any, list[str]]:
    """Return the function that reads the variables of a kind among those watched, their numbers, rows and names."""
    own = [name for name in watched if contact.component.variables[name].type == kind]
    get = function(contact, f"Get{'Integer' if kind == 'Enumeration' else kind}", *ADDRESSES)
    return get, numbers(contact, own), np.zeros((count, len(own)), dtype=READ[kind]), own
