"""Runs words through automata that AALpy loads from DOT, and saves them again.

Usage: aalpy_words.py FOLDER. For every `N.dot` in it there is an `N.words`, a word a
line, symbols separated by spaces. Writes `N.labels`, a `0` or `1` a line, and
`N_saved.dot`.
"""

import pathlib
import sys

from aalpy.utils import load_automaton_from_file, save_automaton_to_file

for path in sorted(pathlib.Path(sys.argv[1]).glob("*.dot")):
    automaton = load_automaton_from_file(path, "dfa")
    labels = []
    for line in path.with_suffix(".words").read_text().splitlines():
        state = automaton.initial_state
        for symbol in line.split():
            # AALpy takes letters of digits for numbers.
            state = state.transitions[int(symbol) if symbol.isdigit() else symbol]
        labels.append("1" if state.is_accepting else "0")
    path.with_suffix(".labels").write_text("\n".join(labels))
    save_automaton_to_file(automaton, path.with_name(path.stem + "_saved"), "dot")
