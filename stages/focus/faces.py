"""Faces, and eyes and mouth in them."""

from dataclasses import dataclass

from stages.focus.strength import Strength


@dataclass(frozen=True)
class Faces(Strength):
    """Errors count 5 times on faces and 10 times on eyes and mouths."""


@dataclass(frozen=True)
class Auto(Faces):
    """Faces where there are any, else nothing."""
