#!/usr/bin/env python3
"""Are the lanes of a warp together wherever the assembled code needs them to be?

    lanes.py NAME FILE      FILE: what `nvdisasm -c` prints of an assembled module; NAME stands before what is found

What is needed. SHFL, VOTE, MATCH, REDUX and BAR do not wait: they are done by the lanes that come to them together. So each
must be reached by the whole warp at once (TOGETHER). What the assembler adds of itself to save atomics (a vote of a constant,
"who is here", and shuffles that index by its result or ask whether there is a lane) needs only a set of lanes that has
counted itself and has not parted since (COUNTED). A VOTEU of a lane's predicate, which the assembler writes to learn
whether a uniform register is wanted here, needs nothing: any set of lanes gets its own answer. The PTX has no vote of that
form that matters (`Lane::any` is for speed alone; `Block::any` is a BAR.RED).

What is proven: on every path from the kernel's entry, by data flow over the graph of basic blocks, calls included. All that
is not known counts as APART.
 1. A kernel begins TOGETHER. A function begins as the worst of its calls.
 2. A branch, an exit or a table of targets parts the lanes, unless its condition is the same in all of them: computed, while
    they were together, from constants, parameters, the block's number, uniform registers and loads from one address.
 3. A WARPSYNC of all lanes brings them TOGETHER: WARPSYNC.ALL, or with a mask that is -1 or the bits up to the own lane or-ed
    with those above it (the mask of kernels/src/exec, which the assembler does not see through). So does WARPSYNC.COLLECTIVE,
    up to its ENDCOLLECTIVE, and a BRA.DIV that is not taken or a BRA.CONV that is: they ask the hardware whether all are there.
 4. A BSYNC brings them TOGETHER if its BSSY was reached TOGETHER and on no path between the two is a BREAK, a BMOV or a BSSY of
    that register, or a call of a function in which one of these stands. Behind a BREAK, of whatever register, no BSYNC is
    believed: on an H200 the lanes come back from such loops in groups, and the outer BSYNC does not hold them.
 5. A warp barrier that is written as a question (VOTEU who is here, MATCH and REDUX.OR of the mask, BRA.DIV unless masks differ) counts
    as that BRA.DIV where the mask is known to be all lanes; then MATCH and REDUX find the same whoever comes.
 6. Behind a call they are APART, unless the function is one way without a branch; one without a RET (a panic) does not
    come back. A BAR changes nothing: it waits for the lanes but need not bring them back in step.
Not proven: that lanes which have left (EXIT) are not missed, and that the hardware does what its opcodes say in 3 and 4.
Code that it cannot read is an error, never silence.
"""
import re
import sys

APART, COUNTED, TOGETHER = 0, 1, 2
CODE = re.compile(r"^\s+/\*([0-9a-f]+)\*/\s+(?:@(!?U?P\w) )?([A-Z][A-Z0-9_.]*)\s*(.*?)\s*(\(\*.*\*\))?\s*;")
NAMES = re.compile(r"UR\d+|UP\d|SR_[\w.]+|SRZ|\bB\d+|R\d+(?:\.64)?|P\d|c\[[^\]]*\]\[R\d+")
# What computes the same from the same, in every lane.
PURE = set("""IMAD IADD3 IADD ISETP MOV SEL LOP3 SHF LEA PLOP3 PRMT SGXT POPC FLO VIADD VIMNMX VIMNMX3 VIADDMNMX IMNMX IABS BMSK
    I2F I2FP F2I F2F FADD FMUL FFMA FSETP FSEL FMNMX FSET MUFU HFMA2 DADD DMUL DFMA DSETP P2R R2P LDC LDS LDG R2UR S2R CS2R VOTE B2R""".split())
SAME = ("SR_CTAID", "SR_NCTAID", "SR_NTID", "SR_Cga", "SRZ")
# What writes no register, and needs no lane but its own.
SILENT = set("""NOP ST STG STL STS RED MEMBAR ERRBAR CGAERRBAR CCTL DEPBAR LDGDEPBAR YIELD NANOSLEEP BAR B2R FENCE
    WARPSYNC ENDCOLLECTIVE BSSY BSYNC BREAK PREEXIT UCGABAR_ARV ACQBULK""".split())
# Where a block ends. A trap (BPT) ends the launch.
ENDS = ("BRA", "BRX", "EXIT", "RET", "BPT")
UNREADABLE = {"JMP", "JMX", "JMXU", "BRXU", "RTT", "KILL", "PCNT", "ELECT", "R2B", "WARPSYNC.EXCLUSIVE"}


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
        self.wide = 1
        if ".64" in name or "WIDE" in name or self.op[0] == "D" or "64" in name or name == "CS2R":
            self.wide = 2
        if ".128" in name or ".256" in name:
            self.wide = 8 if ".256" in name else 4
        # A VOTE of a constant asks who is here.
        self.counts = self.op in ("VOTE", "VOTEU") and self.parts[-1] in ("PT", "UPT")
        self.reads, self.writes = self.registers()

    def converts_from_32(self):
        """Whether it makes a wide number of a narrow one."""
        wide = {"I2F": r"[US]64", "F2I": "F64", "F2F": r"F64$"}.get(self.op)
        return wide is not None and not re.search(wide, self.name)

    def registers(self):
        """Names of what is read and what is written, pairs and quads included."""
        first = 0
        if self.op not in SILENT and self.op not in (*ENDS, "CALL") or self.op == "B2R":
            plain = r"(UR\d+|UP\d|R\d+|P\d|RZ|PT|URZ|UPT|PR|B\d+)"
            kinds = [part[0] if re.fullmatch(plain, part) else "" for part in self.parts]
            if kinds and kinds[0]:
                # Predicates that lead, one register, predicates behind it: all may be results.
                is_predicate = lambda i: i < len(kinds) and re.fullmatch(r"U?P[\dT]", self.parts[i]) is not None
                sets = "SETP" in self.op or "PLOP3" in self.op
                while is_predicate(first) and not (sets and first == 2):
                    first += 1
                if not sets and first < len(kinds) and kinds[first]:
                    first += 1
                    while is_predicate(first) and self.op not in ("SEL", "FSEL", "USEL", "P2R"):
                        first += 1
                if self.op in ("VOTE", "VOTEU"):
                    first = min(first, len(self.parts) - 1)
        writes, reads = [], []
        for i, part in enumerate(self.parts):
            for name in NAMES.findall(part):
                if name.startswith("c["):
                    name = name[name.rindex("R"):]
                # A load's address is as wide as it says; of a wide product only what is added is.
                narrow = i >= first and (self.op.startswith("LD") or "WIDE" in self.name and i != first + 2 or self.converts_from_32())
                width = max(1 if narrow else self.wide, 2 if name.endswith(".64") else 1)
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


class State:
    """What is known where: of the warp, of registers (in how far the lanes have the same), of masks, of barriers."""

    def __init__(self, warp, same, masks, held):
        self.warp, self.same, self.masks, self.held = warp, same, masks, held

    def copy(self):
        return State(self.warp, dict(self.same), dict(self.masks), dict(self.held))

    def meet(self, other):
        """Forgets what the other does not know; whether that was anything."""
        before = (self.warp, sum(self.held.values()), len(self.masks), sum(self.same.values()))
        self.warp = min(self.warp, other.warp)
        self.same = {r: min(level, other.same[r]) for r, level in self.same.items() if r in other.same}
        self.masks = {r: mask for r, mask in self.masks.items() if other.masks.get(r) == mask}
        self.held = {b: min(level, other.held[b]) for b, level in self.held.items() if b in other.held}
        return before != (self.warp, sum(self.held.values()), len(self.masks), sum(self.same.values()))

    def level(self, names):
        """In how far the lanes have the same in all of these."""
        return min((self.of(name) for name in names), default=TOGETHER)

    def of(self, name):
        if name.startswith("SR"):
            return TOGETHER if name.startswith(SAME) else APART
        if name[0] == "U" or self.masks.get(name, "").startswith(("=", "all")):
            return TOGETHER
        return self.same.get(name, APART)

    def part(self):
        """The lanes go different ways; what only those here had in common is not to be relied on."""
        self.warp = APART
        self.same = {r: level for r, level in self.same.items() if level == TOGETHER}
        self.masks = {r: mask for r, mask in self.masks.items() if mask != "here"}

    def together(self):
        """All lanes are here; what only those of a part had in common says nothing any more."""
        self.part()
        self.warp = TOGETHER

    def write(self, step):
        """What an instruction leaves in its registers."""
        mask = None
        if not step.guard:
            if step.op == "S2R" and step.text.endswith(("SR_LEMASK", "SR_GTMASK")):
                mask = step.text[-6:-4]
            elif re.search(r", (0xffffffff|-0x1)$", step.text) and re.match(r"U?MOV$|IMAD\.MOV|HFMA2", step.name):
                mask = "all"
            elif step.op in ("MOV", "IMAD") and "MOV" in step.name and len(step.reads) == 1:
                mask = self.masks.get(step.reads[0])
            elif step.op == "R2UR" and step.reads:
                mask = self.masks.get(step.reads[0])
            elif step.op == "LOP3" and re.search(r", RZ, 0xfc, !PT$", step.text):
                if {self.masks.get(r) for r in step.reads} == {"LE", "GT"}:
                    mask = "all"
            elif step.counts or step.op == "MATCH" and self.masks.get(step.reads[-1]) == "all":
                mask = "here"
            elif step.op == "REDUX" and step.name == "REDUX.OR":
                mask = self.masks.get(step.reads[-1])
            elif step.op == "LOP3" and re.match(r"P\d, RZ,.*, 0x40, !PT$", step.text):
                mask = "never" if [self.masks.get(r) for r in step.reads] == ["all", "here", "here"] else None
            elif step.op == "LDC" or "MOV" in step.name or step.op == "S2R" and step.reads[0].startswith(SAME):
                # The same value whichever way a lane came, if all ways leave it.
                mask = "=" + step.text.partition(",")[2] if not [r for r in step.reads if r[:2] != "SR"] else None
        level = min(self.warp, self.level(step.reads)) if step.op in PURE or step.op[0] == "U" else APART
        if step.op in ("VOTE", "VOTEU"):
            level = self.warp
        if step.guard:
            level = min(level, self.level([step.guard]), self.level(step.writes))
        for name in step.writes:
            self.same.pop(name, None)
            self.masks.pop(name, None)
            if level > APART:
                self.same[name] = level
            if mask:
                self.masks[name] = mask + name if mask[0] == "=" and step.wide > 1 else mask


def needs(step, masks):
    """What an instruction needs of the warp."""
    if step.op in ("MATCH", "REDUX") and masks.get(step.reads[-1]) == "all":
        return APART
    if step.op in ("BAR", "MATCH", "REDUX", "CREDUX"):
        return TOGETHER
    if step.op == "VOTE" and not step.counts:
        return TOGETHER
    if step.op == "SHFL":
        # The kernels shuffle by SHFL.UP and do not ask whether there is a lane: .ci/ptxas.sh looks into the PTX.
        return TOGETHER if step.name != "SHFL.IDX" and step.parts[0] == "PT" else COUNTED
    return APART


def full(state, part):
    """Whether a mask names all lanes."""
    return part in ("0xffffffff", "-0x1", "~URZ", "~RZ") or state.masks.get(part) == "all"


def pass_by(step, state):
    """What an instruction that does not jump changes."""
    if step.op == "WARPSYNC":
        if not step.guard and (step.name == "WARPSYNC.ALL" or full(state, step.parts[0])):
            state.together()
    elif step.op == "ENDCOLLECTIVE":
        state.part()
    elif step.op == "BSSY":
        state.held.pop(step.barrier, None)
        if state.warp > APART and not step.guard:
            state.held[step.barrier] = state.warp
    elif step.op == "BSYNC":
        if state.held.get(step.barrier, APART) > state.warp and not step.guard:
            state.part()
            state.warp = state.held[step.barrier]
    else:
        if step.op in ("BREAK", "BMOV"):
            state.held = {}
        if step.counts and state.warp == APART:
            state.warp = COUNTED
        state.write(step)


def follow(kernel, at, state, flow):
    """Runs from one block's first instruction to its end; hands what is known to `flow(instruction, state)`; the
    collectives on the way that need more than is known."""
    wrong, first = [], at
    while at < len(kernel.steps):
        if at != first and at in kernel.leaders:
            flow(at, state)
            return wrong
        step, at = kernel.steps[at], at + 1
        if state.warp < needs(step, state.masks):
            wrong.append(step)
        if step.op in ENDS:
            conditions = [part.lstrip("!") for part in step.parts if re.fullmatch(r"!?U?P\d", part)]
            conditions += [step.guard] if step.guard else []
            if step.name in ("BRA.DIV", "BRA.CONV"):
                never = step.unless and state.masks.get(step.guard) == "never"
                asks = (never or not step.guard) and full(state, step.parts[0])
                there, here = (at, kernel.labels[step.to]) if step.name == "BRA.DIV" else (kernel.labels[step.to], at)
                if not asks or state.warp < TOGETHER:
                    flow(here, parted(state))
                if asks:
                    state.together()
                flow(there, state)
                return wrong
            if step.op == "BRX":
                if not step.targets:
                    raise Unreadable(f"{kernel.name}: BRX at {step.at:#x} without its targets")
                conditions += step.reads
            if state.level(conditions) < state.warp:
                state.part()
            targets = [step.to] if step.op == "BRA" else step.targets
            for target in targets:
                flow(kernel.labels[target], state)
            if step.guard or step.op == "BRA" and conditions:
                flow(at, state)
            return wrong
        if step.op == "CALL":
            if step.to not in kernel.functions:
                raise Unreadable(f"{kernel.name}: CALL at {step.at:#x}")
            entry = state.copy()
            entry.held = {}
            flow(kernel.functions[step.to], entry)
            if step.to not in kernel.returns and not step.guard:
                return wrong
            if step.to in kernel.straight:
                for i in kernel.body[step.to]:
                    pass_by(kernel.steps[i], state)
                continue
            state.part()
            meddled = state.held if step.to in kernel.breaks else kernel.barriers[step.to]
            state.held = {b: level for b, level in state.held.items() if b not in meddled}
            for name in kernel.clobbers[step.to]:
                state.same.pop(name, None)
                state.masks.pop(name, None)
        else:
            if step.name == "WARPSYNC.COLLECTIVE":
                flow(kernel.labels[step.to], parted(state))
            pass_by(step, state)
    return wrong


def parted(state):
    """The same, with the lanes apart."""
    other = state.copy()
    other.part()
    return other


def judge(kernel):
    """The collectives of a kernel that some path reaches with too few lanes."""
    kernel.leaders = {kernel.labels[to] for step in kernel.steps for to in (step.to, *step.targets) if to in kernel.labels}
    kernel.leaders |= set(kernel.functions.values())
    kernel.leaders |= {i + 1 for i, step in enumerate(kernel.steps) if step.op in ENDS}
    known, todo = {0: State(TOGETHER, {}, {}, {})}, [0]

    def flow(at, state):
        if at >= len(kernel.steps):
            return
        if at not in known:
            known[at] = state.copy()
        elif not known[at].meet(state):
            return
        if at not in todo:
            todo.append(at)

    while todo:
        at = todo.pop()
        follow(kernel, at, known[at].copy(), flow)
    wrong = {}
    for at, state in sorted(known.items()):
        for step in follow(kernel, at, state.copy(), lambda _at, _state: None):
            wrong[step.at] = step
    return [wrong[at] for at in sorted(wrong)]


def main():
    name, path = sys.argv[1:]
    try:
        kernels = read(path)
        asked = sum(needs(step, {}) > APART for kernel in kernels for step in kernel.steps)
        found = [(kernel, step) for kernel in kernels for step in judge(kernel)]
    except (Unreadable, KeyError, IndexError, OSError) as problem:
        print(f"{name}: cannot be read: {problem!r}")
        return 2
    for kernel, step in found:
        print(f"{name}: {kernel.name}: {step.name} {step.text} at {step.at:#x} may find lanes apart")
    if not kernels or not asked:
        print(f"{name}: no collective found in {len(kernels)} kernels")
        return 2
    bad = len({kernel.name for kernel, _ in found})
    print(f"{name}: {len(kernels)} kernels, {asked} collectives and barriers, {len(found)} in {bad} kernels may find lanes apart")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
