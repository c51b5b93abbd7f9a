"""Arrays of other libraries, recognized by their protocols. None of these libraries is imported here."""

from ._native import Device, is_on_gpu


def on_host(array):
    """Return the array if numpy can read it, else a copy from the GPU."""
    if not is_on_gpu(array):
        return array
    for copy in (lambda: array.detach().cpu().numpy(), lambda: array.get(), lambda: array.numpy()):
        try:
            return copy()
        except AttributeError:
            continue
    raise TypeError(f"an array of type {type(array).__name__} is on a GPU; pass a copy in host memory")


def device_of(array):
    """Return a device that can read the array: its GPU, else the default.

    With DLPack an array names its GPU, and makes the reader wait for it. An array without DLPack is on the GPU that this thread
    is bound to, and made on its default stream.
    """
    if not is_on_gpu(array):
        return Device()
    if hasattr(array, "__dlpack_device__"):
        return Device(gpu=int(array.__dlpack_device__()[1]))
    return Device(stream=0)
