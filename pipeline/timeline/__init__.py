"""What changes over time: sections, curves and transitions, from a file to the look of a frame.

    show_file, sections, keyframes, expression    read a file: mistakes are told with their line
    clock, signals                                what time it is at a frame: seconds, beats, bars
    order                                         when sections begin and end in one film
    show                                          the look of a frame
    course                                        what of it changes meshes

Nothing here knows the options: a look is a dataclass whose members come from registries.
"""
