"""What nearmiss raises: a class for each who must act, the message with what to do."""


class NearmissError(Exception):
    """The base of all of them."""


class InputError(NearmissError, ValueError):
    """A mesh that cannot be used: the message names the vertex or the face. Mend the input."""


class ChoiceError(NearmissError, ValueError):
    """Choices that do not exist or do not go together. Choose again."""


class DeviceError(NearmissError, RuntimeError):
    """The machine refused, or there is none. The message has its driver's text."""


class OutOfMemory(NearmissError, MemoryError):
    """Memory ran out. Nothing was lost in silence: there is no answer."""


class Interrupted(NearmissError, RuntimeError):
    """Another thread has called Detector.interrupt. There is no answer, and the detector can be used again."""


class Bug(NearmissError, RuntimeError):
    """A fault of nearmiss itself. Tell us."""
