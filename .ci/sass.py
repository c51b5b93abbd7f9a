"""The machine code of a module as `nvdisasm -c` prints it: kernels of instructions, with what each reads and writes.

Code that cannot be read is an error, never silence.
"""
import re

CODE = re.compile(r"^\s+/\*([0-9a-f]+)\*/\s+(?:@(!?U?P\w) )?([A-Z][A-Z0-9_.]*)\s*(.*?)\s*(\(\*.*\*\))?\s*;")
NAMES = re.compile(r"UR\d+|UP\d|SR_[\w.]+|SRZ|\bB\d+|R\d+(?:\.64)?|P\d|c\[[^\]]*\]\[R\d+")
# Operations that write none of the registers that they name first.
SILENT = ("NOP", "BAR", "WARPSYNC", "BSSY", "BSYNC", "BREAK")
# Ends of a block. A trap (BPT) ends the launch.
ENDS = ("BRA", "BRX", "EXIT", "RET", "BPT")
UNREADABLE = ("JMP", "JMX", "JMXU", "BRXU", "RTT", "KILL", "ELECT", "R2B")


class Unreadable(Exception):
    """Code that this analysis does not know."""


class Step:
    """One instruction: its place, what it is, what it reads and writes."""

    def __init__(self, at, guard, name, text, rest):
        self.at, self.name, self.text = at, name, text
        self.op = name.split(".")[0]
        if self.op in UNREADABLE or name in UNREADABLE:
            raise Unreadable(f"{name} at {at:#x}")
        self.unless = bool(guard) and guard[0] == "!"
        self.guard = guard.lstrip("!") if guard and guard.lstrip("!") not in ("PT", "UPT") else None
        self.parts = [part.strip() for part in re.split(r",(?![^\[]*\])", text)] if text else []
        jump = re.search(r"`\((\S+?)\)", text)
        self.to = jump.group(1) if jump else None
        # For sm_80 some branches are written as calls of a label that nothing returns from.
        self.op = "BRA" if self.op == "CALL" and self.to and self.to.startswith(".L_") else self.op
        self.targets = re.findall(r"\.L_x_\d+", rest or "") if self.op == "BRX" else []
        self.barrier = next((part for part in self.parts if re.fullmatch(r"B\d+", part)), None)
        # A funnel shift of two registers makes one.
        self.wide = 2 if "64" in name and self.op != "SHF" or "WIDE" in name or self.op[0] == "D" or name == "CS2R" else 1
        self.wide = 8 if ".256" in name else 4 if ".128" in name else self.wide
        # A VOTE of a constant counts the lanes that are here.
        self.counts = self.op in ("VOTE", "VOTEU") and self.parts[-1] in ("PT", "UPT")
        self.reads, self.writes = self.registers()
        # Registers that the assembler spills to memory come back as they were.
        self.spills = False
        place = re.search(r"\[R1(?:\+0x([0-9a-f]+))?\]", text) if rest and "SpillRefill" in rest else None
        if place and self.op in ("STL", "LDL"):
            self.spills = True
            words = [f"spill {int(place[1] or '0', 16) + 4 * k}" for k in range(self.wide)]
            if self.op == "STL":
                self.reads, self.writes = [r for r in self.reads if r != "R1"], words
            else:
                self.reads = words

    def converts_from_32(self):
        """Whether it makes a wide number of a narrow one."""
        wide = {"I2F": r"[US]64", "F2I": "F64", "F2F": r"F64$"}.get(self.op)
        return wide is not None and not re.search(wide, self.name)

    def registers(self):
        """Names of what is read and what is written, pairs and quads included."""
        first = 0
        if self.op not in (*SILENT, *ENDS, "CALL"):
            plain = r"(UR\d+|UP\d|R\d+|P\d|RZ|PT|URZ|UPT|PR|B\d+)"
            kinds = [part[0] if re.fullmatch(plain, part) else "" for part in self.parts]
            if kinds and kinds[0]:
                # Predicates that lead, one register, predicates behind it: all may be results.
                is_predicate = lambda i: i < len(kinds) and re.fullmatch(r"U?P[\dT]", self.parts[i])
                sets = "SETP" in self.op or "PLOP3" in self.op
                while is_predicate(first) and not (sets and first == 2):
                    first += 1
                if not sets and first < len(kinds) and kinds[first]:
                    first += 1
                    while is_predicate(first) and self.op not in ("SEL", "FSEL", "USEL", "P2R"):
                        first += 1
                first = min(first, len(self.parts) - 1) if self.op in ("VOTE", "VOTEU") else first
        writes, reads = [], []
        for i, part in enumerate(self.parts):
            for name in NAMES.findall(part):
                if name.startswith("c["):
                    name = name[name.rindex("R"):]
                # A load's address is as wide as it says; of a wide product only what is added is.
                narrow = self.op.startswith("LD") or "WIDE" in self.name and i != first + 2 or self.converts_from_32()
                width = max(1 if narrow and i >= first else self.wide, 2 if name.endswith(".64") else 1)
                name = name.removesuffix(".64")
                many = [name]
                if name[0] == "R" and name[1:].isdigit():
                    many = [f"R{int(name[1:]) + k}" for k in range(width)]
                (writes if i < first else reads).extend(many)
        if self.op in ("P2R", "R2P"):
            # Predicates packed into a register, those of the mask.
            (reads if self.op == "P2R" else writes).extend(f"P{k}" for k in range(7) if int(self.parts[-1], 16) >> k & 1)
        return reads, writes


class Kernel:
    """A kernel and the functions in its section."""

    def __init__(self, name):
        self.name, self.steps, self.labels, self.functions = name, [], {}, {name: 0}

    def finish(self):
        """What each function writes, and whether it meddles with barriers of those that call it."""
        starts = sorted(self.functions.items(), key=lambda item: item[1])
        ends = [at for _, at in starts[1:]] + [len(self.steps)]
        self.body = {name: range(at, end) for (name, at), end in zip(starts, ends)}
        self.clobbers = {name: {w for i in body for w in self.steps[i].writes} for name, body in self.body.items()}
        self.barriers = {name: {s.barrier for i in body for s in [self.steps[i]] if s.op in ("BSSY", "BMOV")} - {None}
                         for name, body in self.body.items()}
        self.breaks = {name for name, body in self.body.items() if any(self.steps[i].op in ("BREAK", "BMOV") for i in body)}
        self.returns = {name for name, body in self.body.items() if any(self.steps[i].op == "RET" for i in body)}
        parting = (*ENDS, "CALL", "BSSY", "BSYNC", "BREAK", "BMOV", "ENDCOLLECTIVE")
        self.straight = {name for name, body in self.body.items()
                         if [self.steps[i].op for i in body if self.steps[i].op in parting] in (["RET"], ["RET", "BRA"])}
        calls = {name: {self.steps[i].to for i in body if self.steps[i].op == "CALL"} for name, body in self.body.items()}
        before = None
        while before != (before := sum(map(len, [*self.clobbers.values(), *self.barriers.values(), self.breaks]))):
            for name, called in calls.items():
                for other in called:
                    if other not in self.functions:
                        raise Unreadable(f"a call of {other}")
                    self.clobbers[name] |= self.clobbers[other]
                    self.barriers[name] |= self.barriers[other]
                    if other in self.breaks:
                        self.breaks.add(name)


def read(path):
    """The kernels of a disassembled module."""
    kernels, kernel, functions = [], None, set()
    for line in open(path, encoding="utf-8", errors="replace"):
        if step := CODE.match(line):
            if kernel is None:
                raise Unreadable("code before a section")
            kernel.steps.append(Step(int(step[1], 16), *step.groups()[1:]))
        elif line.startswith("//-----") and ".text." not in line:
            kernel = None
        elif label := re.match(r"^(\S+):\s*$", line):
            name = label[1]
            if name.startswith(".text."):
                kernel = Kernel(name.removeprefix(".text."))
                kernels.append(kernel)
            elif kernel is not None:
                kernel.labels[name] = len(kernel.steps)
                if name in functions:
                    kernel.functions[name] = len(kernel.steps)
        elif function := re.match(r"^\s*\.type\s+(\S+),@function", line):
            functions.add(function[1])
        elif re.match(r"^\s+/\*[0-9a-f]{4,}\*/\s+\S", line) and kernel is not None:
            raise Unreadable(line.strip())
    for kernel in kernels:
        kernel.finish()
    return kernels
