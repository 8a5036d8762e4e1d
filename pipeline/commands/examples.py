"""Examples with which the help of a command ends: each shows that command."""

ABOUT_ALL = (
    "animate clip.mp4 -o triangles.mp4",
    "animate clip.mp4 -o triangles.mp4 --triangles 3000 --style flat --style edges",
    "animate photo.jpg -o poster.png --triangles 700 --scale 2",
    "animate clip.mp4 -o quick.mp4 --preset preview",
    "solve clip.mp4 -o clip.mtrk --jobs 4",
    "render clip.mtrk -o lines.mp4 --style flat --style edges --scale 2",
)
"""What the help without a command shows."""

EXAMPLES: dict[str, tuple[str, ...]] = {
    "animate": (
        *ABOUT_ALL[:2],
        "animate clip.mp4 -o part.webm --frames 100-199 --color linear --scale 0.5",
        *ABOUT_ALL[2:4],
        'animate "shot_####.png" -o "out/shot_####.png" --fps 24',
    ),
    "solve": (
        "solve clip.mp4 -o clip.mtrk",
        "solve clip.mp4 -o clip.mtrk --triangles 3000 --jobs 4",
        "solve clip.mp4 -o clip.mtrk --resume",
    ),
    "render": (
        "render clip.mtrk -o lines.mp4 --style flat --style edges --scale 2",
        "render clip.mtrk -o ink.mp4 --style crosshatching:paper=#f8f4ea --frames 100-199",
        "render clip.mtrk -o glass.mp4 --source moved/clip.mp4 --style lenses",
    ),
    "edit": (
        "edit clip.mp4 --triangles 1500",
        "edit photo.jpg",
        "edit clip.mtrk --no-open --port 8000",
    ),
    "preview": (
        "preview clip.mp4",
        "preview clip.mp4 -o look.png --style hatching --triangles 3000 --scale 2",
    ),
    "plan": (
        "plan film.mp4",
        "plan film.mp4 --parts 4 --json",
        "plan film.mp4 --format slurm -o film.mtrk --triangles 3000 > film.sh",
    ),
    "join": ("join part1.mtrk part2.mtrk part3.mtrk -o film.mtrk",),
    "info": ("info clip.mp4", 'info "shot_####.png"', "info clip.mtrk --json"),
    "measure": (
        "measure clip.mp4 triangles.mp4",
        "measure clip.mp4 triangles.mp4 --track clip.mtrk --json",
        "measure clip.mp4 part.webm --frames 100-199",
    ),
    "styles": (
        "styles",
        "styles hatching",
        "styles photo.jpg --sheet sheet.png",
    ),
    "timeline": (
        "timeline show.toml --check clip.mp4",
        "timeline pulse --check clip.mp4 -o strip.png",
        "timeline pulse > mine.toml",
    ),
    "listen": (
        "listen song.flac -o song.beats.json --plot song.png",
        "listen clip.mp4 --labels beats.txt --bpm 120",
        "listen song.flac --beats beats.txt -o song.beats.json --overwrite",
    ),
    "doctor": ("doctor", "doctor --json"),
    "completion": (
        "completion bash > ~/.local/share/bash-completion/completions/trimotion",
        "completion zsh > ~/.zfunc/_trimotion",
        "completion fish > ~/.config/fish/completions/trimotion.fish",
    ),
    "help": ("help", "help render"),
}
"""Of every command."""


def shown(lines: tuple[str, ...]) -> str:
    """Examples as the help prints them.

    Args:
        lines: Commands without the program's name.
    """
    return "\n".join(["examples:", *(f"  trimotion {line}" for line in lines), ""])
