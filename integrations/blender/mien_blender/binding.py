# SPDX-License-Identifier: MIT
"""The Python binding of Mien, under the private name by which the add-on carries it."""
try:
    from . import _mien as mien  # the zip of the add-on holds it
except ImportError:
    import mien_blender_runtime as mien  # a wheel of the extension

__all__ = ["mien"]
