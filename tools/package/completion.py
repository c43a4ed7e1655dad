#!/usr/bin/env python3
"""Writes bash's completion of scree, screed and scree-spy from what they say to --help.

completion.py SCREE SCREED SCREE_SPY > FILE
"""

import os
import re
import subprocess
import sys


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
    return [word.split("->")[0].strip() for word in listed[1].split(",")] if listed else []


def described(text):
    """Options, the words that follow some of them, those that a value follows, and the words of the
    positionals."""
    options, words, valued = [], {}, []
    for names, kind in entries(text, "Options"):
        name = names.split(",")[-1]
        options.append(name)
        if choices(kind):
            words[name] = choices(kind)
        elif kind and not kind.split()[0].endswith(":"):
            valued.append(name)
    positional = [word for _, kind in entries(text, "Positionals") for word in choices(kind)]
    return options, words, valued, positional


def branch(pattern, options, words):
    return f'    {pattern}) options="{" ".join(options)}" words="{" ".join(words)}" ;;'


def cases(command, text):
    """The branches for one command: after an option that takes a value, and else."""
    options, words, valued, positional = described(text)
    for option, values in words.items():
        yield branch(f'"{command} "{option}', [], values)
    for option in valued:
        yield f'    "{command} "{option}) return ;;'
    yield branch(f'"{command} "*', options, positional)


def main():
    scree, *others = sys.argv[1:]
    overview = help_of(scree)
    subcommands = [name for name, _ in entries(overview, "Subcommands")]
    branches = [case for name in subcommands for case in cases(f"scree {name}", help_of(scree, name))]
    for other in others:
        branches += cases(os.path.basename(other), help_of(other))
    first = branch('"scree "*', described(overview)[0], subcommands)
    print("# Made from what the programs say to --help. Where no word fits, bash offers files.")
    print("_scree() {")
    print('  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} options words')
    print("  local command=${COMP_WORDS[0]##*/}")
    print("  COMPREPLY=()")
    print('  [[ $command == scree ]] && ((COMP_CWORD > 1)) && command+=" ${COMP_WORDS[1]}"')
    print('  case "$command $before" in')
    print("\n".join(branches))
    print(first)
    print("  esac")
    print("  [[ $current == -* ]] && words=$options")
    print('  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")')
    print("}")
    print("complete -o default -F _scree", "scree", *map(os.path.basename, others))


main()
