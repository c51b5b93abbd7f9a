"""What nearmiss raises: a class for each who must act, the message with what to do.

Numbers that describe meshes, positions and poses, in files and in arrays, are input (InputError); all else that a caller passes
(options, names, kinds, numbers of bodies, shapes and types of arrays) is a choice (InvalidArgumentError).
"""


class NearmissError(Exception):
    """The base of all of them."""


class InputError(NearmissError, ValueError):
    """Data that cannot be used: a file, or numbers of a mesh, of positions or of a pose. Correct the data."""


class InvalidArgumentError(NearmissError, ValueError):
    """An argument that does not exist or does not go with the others, whatever the data. Choose again."""


class DeviceError(NearmissError, RuntimeError):
    """The machine refused, or there is none. The message has its driver's text."""


class OutOfMemory(NearmissError, MemoryError):
    """Memory ran out. Nothing was lost in silence: there is no answer."""


class MeshWarning(UserWarning):
    """A mesh has less than its file, or a face is cut as it can be: read_mesh counts such parts."""


class Interrupted(NearmissError, RuntimeError):
    """Another thread has called Detector.interrupt. There is no answer, and the detector can be used again."""


class Bug(NearmissError, RuntimeError):
    """A fault of nearmiss itself. Tell us."""
