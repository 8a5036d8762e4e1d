"""How coherent two frames are: one measure a file, each of two frames of one shot; and whether a
film flashes.

Motion is always that of the source: an output that does not move with its source is to be found
out, not followed.
"""
