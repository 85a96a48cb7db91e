"""Learns targets with AALpy's L*, KV and L#, and counts what they ask.

Reads one JSON object from the standard input:
    {"counterexamples": "shortest" or "random", "seeds": [0, ...], "targets": [
      {"symbols": 2, "start": 0, "accepting": [0], "delta": [[0, 1], ...],
       "known": [[], [0, 1], ...], "open": {"start": 0, ...}}, ...]}
and writes one JSON object a line, in the order of targets, rivals and seeds:
    {"target": 0, "rival": "kv", "seed": 0, "membership": 9, "equivalence": 2}

Counted are distinct words whose labels the algorithm was told, apart from words
known at the start and from counterexamples. L* and KV look at the label of the
whole word only; L# also at those of its prefixes, which are words like any others.
Words that `open`, which may be missing, rejects are settled by what is known
beforehand: their labels are not counted, nor are equivalence queries that one of
them answers.
"""

import json
import random
import sys
from collections import deque

from aalpy.base import Oracle, SUL
from aalpy.learning_algs import run_KV, run_Lsharp, run_Lstar

# Random counterexamples are no longer than this where a shorter one exists.
LONGEST = 10


class Target(SUL):
    """The target as a black box that notes every word it is asked for."""

    def __init__(self, table, prefixes):
        super().__init__()
        self.table = table
        self.accepting = set(table["accepting"])
        self.prefixes = prefixes
        self.free = {tuple(word) for word in table["known"]}
        everything = {"start": 0, "accepting": [0], "delta": [[0] * table["symbols"]]}
        self.open = table.get("open", everything)
        self.asked = set()
        self.pre()

    def pre(self):
        self.state = self.table["start"]
        self.word = ()

    def step(self, symbol):
        if symbol is not None:
            self.state = self.table["delta"][self.state][symbol]
            self.word += (symbol,)
        if self.prefixes:
            self.asked.add(self.word)
        return self.state in self.accepting

    def post(self):
        self.asked.add(self.word)

    def count(self):
        return sum(self.is_open(word) for word in self.asked - self.free)

    def is_open(self, word):
        state = self.open["start"]
        for symbol in word:
            state = self.open["delta"][state][symbol]
        return state in self.open["accepting"]


class Teacher(Oracle):
    """Compares the hypothesis with the target exactly, and never misses."""

    def __init__(self, target, kind, draws):
        super().__init__(list(range(target.table["symbols"])), target)
        self.kind = kind
        self.draws = draws
        # Whether it looks among the settled words, and how often it had to ask.
        self.settled = False
        self.counted = 0

    def find_cex(self, hypothesis):
        table, outline = self.sul.table, self.sul.open
        start = (table["start"], hypothesis.initial_state, outline["start"])
        self.settled = True
        word = self.shortest(start)
        if word is not None:
            return word
        self.settled = False
        self.counted += 1
        word = self.shortest(start)
        if word is None:
            return None
        if self.kind == "random":
            word = self.drawn(start, max(LONGEST, len(word)))
        # The teacher says its label; it is not asked for.
        self.sul.free.add(word)
        return word

    def differ(self, place):
        if (place[2] in self.sul.open["accepting"]) == self.settled:
            return False
        return (place[0] in self.sul.accepting) != bool(place[1].is_accepting)

    def after(self, place, symbol):
        return (
            self.sul.table["delta"][place[0]][symbol],
            place[1].transitions[symbol],
            self.sul.open["delta"][place[2]][symbol],
        )

    def shortest(self, start):
        queue, seen = deque([(start, ())]), {self.name(start)}
        while queue:
            place, word = queue.popleft()
            if self.differ(place):
                return word
            for symbol in self.alphabet:
                following = self.after(place, symbol)
                if self.name(following) not in seen:
                    seen.add(self.name(following))
                    queue.append((following, word + (symbol,)))
        return None

    def drawn(self, start, longest):
        """Of the lengths that some counterexample has, one; of that length any."""
        counts = {}

        def count(place, length):
            key = (self.name(place), length)
            if key not in counts:
                if length == 0:
                    counts[key] = int(self.differ(place))
                else:
                    nexts = (self.after(place, symbol) for symbol in self.alphabet)
                    counts[key] = sum(count(following, length - 1) for following in nexts)
            return counts[key]

        lengths = [n for n in range(longest + 1) if count(start, n)]
        left = self.draws.choice(lengths)
        place, word = start, ()
        while left:
            left -= 1
            weights = [count(self.after(place, symbol), left) for symbol in self.alphabet]
            symbol = self.draws.choices(self.alphabet, weights)[0]
            place, word = self.after(place, symbol), word + (symbol,)
        return word

    @staticmethod
    def name(place):
        return (place[0], place[1].state_id, place[2])


RIVALS = {
    "lstar": (run_Lstar, False),
    "kv": (run_KV, False),
    "lsharp": (run_Lsharp, True),
}


def main():
    task = json.load(sys.stdin)
    for number, table in enumerate(task["targets"]):
        for rival, (learn, prefixes) in RIVALS.items():
            for seed in task["seeds"]:
                random.seed(seed)
                target = Target(table, prefixes)
                teacher = Teacher(target, task["counterexamples"], random.Random(seed))
                learn(
                    teacher.alphabet,
                    target,
                    teacher,
                    automaton_type="dfa",
                    cache_and_non_det_check=False,
                    print_level=0,
                )
                line = {
                    "target": number,
                    "rival": rival,
                    "seed": seed,
                    "membership": target.count(),
                    "equivalence": teacher.counted,
                }
                print(json.dumps(line), flush=True)


main()
