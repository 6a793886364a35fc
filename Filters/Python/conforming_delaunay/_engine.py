# SPDX-License-Identifier: BSD-3-Clause
"""Runs stages of the engine, a library in C++, by ctypes: Filters/Core/CInterface/cdmEngine.h.

Arrays of the engine become NumPy arrays without a copy; they keep its memory alive.
"""

from __future__ import annotations

import ctypes
import enum
import os
import re
import sys
from typing import Any, Callable, Dict, Mapping, Optional, Sequence

import numpy as np


class ErrorCode(enum.IntEnum):
    """Why a stage has failed, as StatusCode of Core/Basics/Status.h."""

    ABORTED = 1
    INVALID_INPUT = 2
    INVALID_OPTION = 3
    NOT_CLOSED = 4
    SELF_INTERSECTING = 5
    NOT_DELAUNAY = 6
    LIMIT_REACHED = 7
    OUT_OF_MEMORY = 8
    INTERNAL_ERROR = 9


class MeshingError(RuntimeError):
    """A stage has failed. The message says what to do.

    Attributes
    ----------
    code : ErrorCode
        What went wrong.
    cells : numpy.ndarray
        Ids of the input's polygons, triangles or tetrahedra that are at fault.
    points : numpy.ndarray
        Ids of the input's points that are at fault.
    arrays : dict of str to numpy.ndarray
        What the stage gave all the same, such as the problems of a surface.
    """

    def __init__(self, code: ErrorCode, message: str, arrays: Mapping[str, Any]):
        super().__init__(message)
        self.code = code
        self.cells = arrays.get("error_cells", np.empty(0, np.int32))
        self.points = arrays.get("error_points", np.empty(0, np.int32))
        self.arrays = {
            name: value for name, value in arrays.items() if not name.startswith("error")
        }


class OptionError(MeshingError, ValueError):
    """An option is unknown, or out of its range."""


class Aborted(MeshingError):
    """The progress function asked to stop."""


#: Gets the finished fraction and what is being done; False aborts.
Progress = Callable[[float, str], Optional[bool]]
#: The longest edge wanted at a position (x, y, z).
SizingFunction = Callable[[float, float, float], float]

_ProgressFunction = ctypes.CFUNCTYPE(
    ctypes.c_int, ctypes.c_double, ctypes.c_char_p, ctypes.c_void_p
)
_SizingFunction = ctypes.CFUNCTYPE(
    ctypes.c_double, ctypes.POINTER(ctypes.c_double), ctypes.c_void_p
)


class _Callbacks(ctypes.Structure):
    _fields_ = [
        ("Progress", _ProgressFunction),
        ("Sizing", _SizingFunction),
        ("Data", ctypes.c_void_p),
        ("NumberOfThreads", ctypes.c_int),
    ]


def _load() -> ctypes.CDLL:
    folder = os.path.dirname(os.path.abspath(__file__))
    suffix = {"win32": ".dll", "darwin": ".dylib"}.get(sys.platform, ".so")
    path = os.path.join(folder, "libcdmEngine" + suffix)
    if not os.path.exists(path):
        # Beside wrapped filters: their library of the engine, which they have loaded.
        from . import cdmMeshing  # type: ignore # noqa: F401
        from ._library import NAME  # type: ignore

        path = NAME
    library = ctypes.CDLL(path)
    library.cdmGetVersion.restype = ctypes.c_char_p
    library.cdmNewArrays.restype = ctypes.c_void_p
    library.cdmDeleteArrays.argtypes = [ctypes.c_void_p]
    library.cdmDeleteArrays.restype = None
    for name, kind in (("cdmSetReals", ctypes.c_double), ("cdmSetIntegers", ctypes.c_int64)):
        getattr(library, name).argtypes = [
            ctypes.c_void_p,
            ctypes.c_char_p,
            ctypes.POINTER(kind),
            ctypes.c_int64,
        ]
    library.cdmGetNumberOfArrays.argtypes = [ctypes.c_void_p]
    library.cdmGetNumberOfArrays.restype = ctypes.c_int64
    library.cdmGetName.argtypes = [ctypes.c_void_p, ctypes.c_int64]
    library.cdmGetName.restype = ctypes.c_char_p
    library.cdmGetValues.argtypes = [
        ctypes.c_void_p,
        ctypes.c_char_p,
        ctypes.POINTER(ctypes.c_int),
        ctypes.POINTER(ctypes.c_int64),
        ctypes.POINTER(ctypes.c_int),
    ]
    library.cdmGetValues.restype = ctypes.c_void_p
    library.cdmRun.argtypes = [
        ctypes.c_char_p,
        ctypes.c_void_p,
        ctypes.c_void_p,
        ctypes.POINTER(_Callbacks),
    ]
    return library


_library = _load()

version: str = _library.cdmGetVersion().decode()


class _Arrays:
    """Owns an object of the engine that holds named arrays."""

    def __init__(self) -> None:
        self.handle = _library.cdmNewArrays()
        if not self.handle:
            raise MemoryError("There is no memory for the arrays of the engine.")

    def __del__(self) -> None:
        if getattr(self, "handle", None):
            _library.cdmDeleteArrays(self.handle)

    def set(self, name: str, value: Any) -> None:
        array = np.asarray(value)
        function: Any
        kind: Any
        if array.dtype.kind == "f":
            array = np.ascontiguousarray(array, np.float64)
            function, kind = _library.cdmSetReals, ctypes.c_double
        elif array.dtype.kind in "iub":
            array = np.ascontiguousarray(array, np.int64)
            function, kind = _library.cdmSetIntegers, ctypes.c_int64
        else:
            raise TypeError(f"{name} has to be a number or an array of numbers, not {value!r}")
        values = array.ctypes.data_as(ctypes.POINTER(kind))
        if function(self.handle, name.encode(), values, array.size) != 0:
            raise MemoryError(f"There is no memory for {name}.")


class _View:
    """Lets NumPy look at values of the engine, and keeps them alive."""

    _types = {0: "<f8", 1: "<i4", 2: "|u1"} if sys.byteorder == "little" else {
        0: ">f8",
        1: ">i4",
        2: "|u1",
    }

    def __init__(self, owner: _Arrays, address: int, kind: int, shape: Sequence[int]):
        self.owner = owner
        self.__array_interface__ = {
            "version": 3,
            "typestr": self._types[kind],
            "shape": tuple(shape),
            "data": (address, False),
        }


def _get(owner: _Arrays, name: bytes) -> Any:
    kind = ctypes.c_int()
    count = ctypes.c_int64()
    components = ctypes.c_int()
    address = _library.cdmGetValues(
        owner.handle, name, ctypes.byref(kind), ctypes.byref(count), ctypes.byref(components)
    )
    if kind.value == 3:
        return ctypes.string_at(address, count.value).decode() if address else ""
    shape = (count.value,) if components.value == 1 else (count.value, components.value)
    if not address or count.value == 0:
        return np.empty(shape, _View._types[kind.value])
    return np.asarray(_View(owner, address, kind.value, shape))


#: Names of the engine that are others in Python.
_PYTHON_NAMES = {"maximum_edge_length": "edge_length"}
_ENGINE_NAMES = {name: engine for engine, name in _PYTHON_NAMES.items()}


def to_engine_name(name: str) -> str:
    """The name of the engine for an option of Python."""
    return _ENGINE_NAMES.get(name, name)


def to_python_name(name: str) -> str:
    """The name in Python of a property or an option of C++: MaximumArea becomes maximum_area."""
    snake = re.sub("(?<!^)([A-Z])", r"_\1", name).lower()
    return _PYTHON_NAMES.get(snake, snake)


def _spell(text: str, inputs: Mapping[str, Any]) -> str:
    """Options by the names that they have in Python: the engine says MaximumGapEdges."""

    def replace(match: Any) -> str:
        name = to_python_name(match.group())
        return name if to_engine_name(name) in inputs else match.group()

    return re.sub(r"\b(?:[A-Z][a-z]+){2,}\b|\b[a-z]+(?:_[a-z]+)+\b", replace, text)


def run(
    stage: str,
    inputs: Mapping[str, Any],
    *,
    sizing: Optional[SizingFunction] = None,
    progress: Optional[Progress] = None,
    threads: int = 0,
) -> Dict[str, Any]:
    """Runs a stage of Filters/Core/CInterface/Stages.h.

    Args:
        stage: its name.
        inputs: arrays and options; None leaves one at its default.
        sizing: a function; arrays of a sizing are among the inputs.
        progress: called on this thread, at least every 50 ms.
        threads: 0: one for each processor core.

    Returns:
        Arrays by name; texts are str.

    Raises:
        MeshingError: and its subclasses. KeyboardInterrupt ends a stage, too; so does whatever
            progress or sizing raise.
    """
    if not isinstance(threads, int) or threads < 0:
        message = f"threads is {threads!r}: it has to be a whole number from 0 on."
        raise OptionError(ErrorCode.INVALID_OPTION, message, {})
    given = _Arrays()
    for name, value in inputs.items():
        if value is not None:
            given.set(name, value)
    raised: list = []

    def on_progress(fraction: float, activity: bytes, _: Any) -> int:
        try:
            wanted = progress(fraction, activity.decode()) if progress else None
            return int(bool(raised) or wanted is False)
        except BaseException as error:  # also KeyboardInterrupt: it must not get lost in C++
            raised.append(error)
            return 1

    def on_sizing(position: Any, _: Any) -> float:
        try:
            assert sizing is not None
            return float(sizing(position[0], position[1], position[2]))
        except BaseException as error:
            raised.append(error)
            return 1e300

    callbacks = _Callbacks(
        _ProgressFunction(on_progress),
        _SizingFunction(on_sizing) if sizing else _SizingFunction(),
        None,
        threads,
    )
    output = _Arrays()
    code = _library.cdmRun(stage.encode(), given.handle, output.handle, ctypes.byref(callbacks))
    if raised:
        raise raised[0]
    arrays = {}
    for i in range(_library.cdmGetNumberOfArrays(output.handle)):
        name = _library.cdmGetName(output.handle, i)
        arrays[name.decode()] = _get(output, name)
    if "warnings" in arrays:
        arrays["warnings"] = _spell(arrays["warnings"], inputs)
    if code != 0:
        kind = {ErrorCode.INVALID_OPTION: OptionError, ErrorCode.ABORTED: Aborted}
        error = ErrorCode(code)
        message = _spell(arrays.get("error", "There is not enough memory."), inputs)
        raise kind.get(error, MeshingError)(error, message, arrays)
    return arrays
