"""Arrays of other libraries, told apart by what they can do. None of these libraries is imported here."""

from ._native import Device, is_on_gpu


def on_host(array):
    """The same array where numpy can read it: copied from a GPU, else itself."""
    if not is_on_gpu(array):
        return array
    for copy in (lambda: array.detach().cpu().numpy(), lambda: array.get(), lambda: array.numpy()):
        try:
            return copy()
        except AttributeError:
            continue
    raise TypeError(f"an array of type {type(array).__name__} on a GPU: give a copy in the host's memory")


def device_of(array):
    """Where to ask about an array: the GPU that it lies on, else any machine.

    By DLPack an array says which GPU that is, and waits for who asks. What has no DLPack is of the GPU that this thread is bound to,
    and made on its default stream.
    """
    if not is_on_gpu(array):
        return Device()
    if hasattr(array, "__dlpack_device__"):
        return Device(gpu=int(array.__dlpack_device__()[1]))
    return Device(stream=0)
