"""Kinds of edits that say something about a region, which follows the picture through its shot."""
