"""Names of another library that are replaced for a while."""


class Replacements:
    """Replaced names and what they were, as a `with` block: its end gives them back."""

    def __init__(self):
        self._own = []

    def put(self, owner, name, value):
        """Replace a name of a module or of a class."""
        self._own.append((owner, name, getattr(owner, name)))
        setattr(owner, name, value)

    def undo(self):
        """Give all names back, the latest first. If there are none, it does nothing."""
        while self._own:
            setattr(*self._own.pop())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.undo()
