"""All commands, as the help without a command lists them."""

COMMANDS_HELP = """\
commands:
  animate INPUT -o OUTPUT    convert a video, a still or numbered stills
  solve INPUT -o JOB.mtrk    convert to a mesh track, from which any look can be drawn
  render JOB.mtrk -o OUTPUT  draw a mesh track
  edit CLIP|STILL|JOB.mtrk   an editor in the browser: edit any frame, and the film follows
  preview INPUT              five moments of that, and the time that it would take
  plan INPUT                 ranges of whole shots, for runs on several machines
  join A.mtrk B.mtrk ... -o OUT.mtrk   put the tracks of ranges together
  info FILE                  what a file is: a source or a mesh track
  measure SOURCE OUTPUT      how close an output is to its source, and how coherent
  styles [NAME]              styles and moves with their parameters; --sheet draws them
  timeline SHOW.toml|NAME --check CLIP   what a timeline does when, without solving
  listen SONG|CLIP -o SONG.beats.json   beats, bars, onsets and strengths of a sound
  doctor                     what this machine has, and whether a conversion works on it
  completion bash|zsh|fish   a script by which a shell completes all of this
  help [COMMAND]             this text, or the options of a command

trimotion COMMAND --help tells the options of a command, too.

"""
