"""Exceptions of nearmiss: a class for each kind of fault.

Numbers of meshes, positions and poses are input (InputError). Everything else that a caller passes is an argument
(InvalidArgumentError): options, names, kinds, body numbers, shapes and types of arrays.
"""


class NearmissError(Exception):
    """Base class of all errors."""


class InputError(NearmissError, ValueError):
    """Data that cannot be used: a file, or numbers of a mesh, of positions or of a pose. Correct the data."""


class InvalidArgumentError(NearmissError, ValueError):
    """Argument that does not exist or does not go with the others, independent of the data. Correct the call."""


class DeviceError(NearmissError, RuntimeError):
    """Failure of the machine, or no such machine. The message has the driver's text."""


class OutOfMemory(NearmissError, MemoryError):
    """Memory that ran out. There is no partial answer."""


class MeshWarning(UserWarning):
    """Parts of a mesh file that read_mesh skipped, left out or cut as a fan."""


class Interrupted(NearmissError, RuntimeError):
    """Call that Detector.interrupt has ended. There is no answer, and the detector can be used again."""


class Bug(NearmissError, RuntimeError):
    """Fault of nearmiss itself. Please report it."""
