"""The one exception for what cannot be used."""
from __future__ import annotations


class InputError(ValueError):
    """An argument, scene or file cannot be used.

    `defects` has everything that one pass found; each names the argument, the file and key, or the element, the
    reason and, where there is one, the remedy. The text of the error has one defect on each line.
    """

    def __init__(self, *defects: str) -> None:
        super().__init__(*defects)

    @property
    def defects(self) -> list[str]:
        return [str(defect) for defect in self.args]

    def __str__(self) -> str:
        return "\n".join(self.defects)
