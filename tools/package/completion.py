#!/usr/bin/env python3
"""Writes a shell's completion of scree, screed and scree-spy from what they say to --help.

completion.py bash|zsh|fish SCREE SCREED SCREE_SPY > FILE
"""

import os
import re
import subprocess
import sys

MADE = "# Made from what the programs say to --help. Where no word fits, files are offered."


def help_of(*command):
    return subprocess.run([*command, "--help"], check=True, capture_output=True, text=True).stdout


def entries(text, heading):
    """What stands left in the lines of a section: a name, and what follows it."""
    section = re.search(rf"^{heading}:\n((?:  .*\n)+)", text, re.M)
    for line in section[1].splitlines() if section else []:
        if not line.startswith("   "):
            name, *rest = re.split(r" {2,}", line.strip())[0].split(" ", 1)
            yield name, rest[0] if rest else ""


def choices(kind):
    """The words that a value may be, where the help lists them."""
    listed = re.search(r"\{(.+?)\}", kind)
    return [word.strip() for word in listed[1].split(",")] if listed else []


class Command:
    """A program, or scree with a subcommand, and what may follow it."""

    def __init__(self, name, text):
        self.name, self.options, self.words, self.valued = name, [], {}, []
        for names, kind in entries(text, "Options"):
            option = names.split(",")[-1]
            self.options.append(option)
            if choices(kind):
                self.words[option] = choices(kind)
            elif kind and not kind.split()[0].endswith(":"):
                self.valued.append(option)
        self.positional = [word for _, kind in entries(text, "Positionals") for word in choices(kind)]


def branches(commands, row, files):
    """The branches of a shell's case: after an option that takes a value, and else."""
    for command in commands:
        for option, words in command.words.items():
            yield f'    "{command.name} "{option}) {row([], words)} ;;'
        for option in command.valued:
            yield f'    "{command.name} "{option}) {files} ;;'
        yield f'    "{command.name} "*) {row(command.options, command.positional)} ;;'


def bash(commands, programs):
    def row(options, words):
        return f'options="{" ".join(options)}" words="{" ".join(words)}"'

    return f"""{MADE}
_scree() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} options words
  local command=${{COMP_WORDS[0]##*/}}
  COMPREPLY=()
  [[ $command == scree ]] && ((COMP_CWORD > 1)) && command+=" ${{COMP_WORDS[1]}}"
  case "$command $before" in
{chr(10).join(branches(commands, row, "return"))}
  esac
  [[ $current == -* ]] && words=$options
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}}
complete -o default -F _scree {" ".join(programs)}"""


def zsh(commands, programs):
    def row(options, words):
        return f"options=({' '.join(options)}) choices=({' '.join(words)})"

    return f"""#compdef {" ".join(programs)}
{MADE}
local command=${{words[1]:t}} before=$words[CURRENT-1]
local -a options choices
[[ $command == scree ]] && ((CURRENT > 2)) && command+=" $words[2]"
case "$command $before" in
{chr(10).join(branches(commands, row, "_files; return"))}
esac
[[ $words[CURRENT] == -* ]] && choices=($options)
if (($#choices)); then compadd -- $choices; else _files; fi"""


def fish(commands, programs):
    lines = [MADE]
    subcommands = " ".join(next(c for c in commands if c.name == "scree").positional)
    for command in commands:
        program, _, subcommand = command.name.partition(" ")
        seen = f"__fish_seen_subcommand_from {subcommand or subcommands}"
        when = f' -n "{"" if subcommand else "not "}{seen}"' if program == "scree" else ""
        line = f"complete -c {program}{when}"
        if command.positional:
            lines.append(f"{line} -f -a '{' '.join(command.positional)}'")
        for option in command.options:
            words = command.words.get(option)
            value = f" -x -a '{' '.join(words)}'" if words else " -r" if option in command.valued else ""
            lines.append(f"{line} -l {option.lstrip('-')}{value}")
    return "\n".join(lines)


def main():
    shell, scree, *others = sys.argv[1:]
    overview = help_of(scree)
    first = Command("scree", overview)
    first.positional = [name for name, _ in entries(overview, "Subcommands")]
    commands = [Command(f"scree {name}", help_of(scree, name)) for name in first.positional]
    commands += [Command(os.path.basename(other), help_of(other)) for other in others]
    programs = ["scree", *map(os.path.basename, others)]
    print({"bash": bash, "zsh": zsh, "fish": fish}[shell]([*commands, first], programs))


main()
