"""What differs between the versions of PyAV that are allowed, 18.1 to 19."""

from typing import Any

import av

IS_18 = int(av.__version__.split(".")[0]) < 19
"""Whether rates are Python's fractions, and text of files is decoded as the caller says; from 19 on
rates are a type of PyAV's own, of which `Fraction` makes one, and text is always read."""

LENIENT: dict[str, Any] = {"metadata_errors": "replace"} if IS_18 else {}
"""Arguments of `av.open`: titles and names in another encoding are no reason to fail."""
