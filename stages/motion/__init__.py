"""A mesh carried along by the motion: advection, occlusion, what is kept and inherited."""
