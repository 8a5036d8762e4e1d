"""What is heard in a sound: beats, bars, onsets and how loud it is, and files that tell of it."""
