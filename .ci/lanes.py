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
 5. A warp barrier that is written as a question (VOTEU who is here, MATCH and REDUX.OR of the mask, BRA.DIV unless masks
    differ) counts as that BRA.DIV where the mask is known to be all lanes; MATCH and REDUX then find the same whoever comes.
 6. Behind a call they are APART, unless the function is one way without a branch; one without a RET (a panic) does not
    come back. A BAR changes nothing: it waits for the lanes but need not bring them back in step.
Not proven: that lanes which have left (EXIT) are not missed, and that the hardware does what its opcodes say in 3 and 4.
Code that it cannot read is an error, never silence.
"""
import re
import sys

from sass import ENDS, Unreadable, read

APART, COUNTED, TOGETHER = 0, 1, 2
# Operations that compute the same from the same, in every lane.
PURE = set("""IMAD IADD3 IADD ISETP MOV SEL LOP3 SHF LEA PLOP3 PRMT SGXT POPC FLO VIADD VIMNMX VIMNMX3 VIADDMNMX IMNMX IABS BMSK
    I2F I2FP F2I F2F FADD FMUL FFMA FSETP FSEL FMNMX FSET MUFU HFMA2 DADD DMUL DFMA DSETP P2R R2P
    LDC LDS LDG R2UR S2R CS2R VOTE B2R""".split())
SAME = ("SR_CTAID", "SR_NCTAID", "SR_NTID", "SR_Cga", "SRZ")


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

    def parted(self):
        """The same, with the lanes apart."""
        other = self.copy()
        other.part()
        return other

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
            elif step.spills and len(step.reads) == 1:
                mask = self.masks.get(step.reads[0])
            elif step.op == "LDC" or "MOV" in step.name or step.op == "S2R" and step.reads[0].startswith(SAME):
                # The same value whichever way a lane came, if all ways leave it.
                mask = "=" + step.text.partition(",")[2] if not [r for r in step.reads if r[:2] != "SR"] else None
            elif step.op in ("SGXT", "SHF", "LOP3", "IADD3", "VIADD") and len(step.writes) == 1:
                # So is what is computed of such values.
                of = [self.masks.get(r, "") for r in step.reads]
                constants = re.sub(r"\bR\d+", "R", step.text.partition(",")[2])
                mask = f"={step.name} {constants} {of}" if of and all(x[:1] == "=" and len(x) < 200 for x in of) else None
        level = min(self.warp, self.level(step.reads)) if step.op in PURE or step.op[0] == "U" or step.spills else APART
        level = self.warp if step.op in ("VOTE", "VOTEU") else level
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
    if step.op in ("MATCH", "REDUX", "CREDUX"):
        return APART if masks.get(step.reads[-1]) == "all" else TOGETHER
    if step.op == "BAR" or step.op == "VOTE" and not step.counts:
        return TOGETHER
    if step.op == "SHFL":
        # The kernels shuffle by SHFL.UP and do not test whether there is a lane: tests/gpu/ptx.rs looks into the text.
        return TOGETHER if step.name != "SHFL.IDX" and step.parts[0] == "PT" else COUNTED
    return APART


def full(state, part):
    """Whether a mask names all lanes."""
    return part in ("0xffffffff", "-0x1", "~URZ", "~RZ") or state.masks.get(part) == "all"


def pass_by(step, state):
    """What an instruction that does not jump changes."""
    if step.op == "WARPSYNC":
        # EXCLUSIVE, in front of a reduction on sm_80, is not believed to bring lanes together: they must be before.
        if step.name == "WARPSYNC.EXCLUSIVE":
            return
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
                    flow(here, state.parted())
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
            for target in [step.to] if step.op == "BRA" else step.targets:
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
                flow(kernel.labels[step.to], state.parted())
            pass_by(step, state)
    return wrong


def judge(kernel):
    """The collectives of a kernel that some path reaches with too few lanes."""
    kernel.leaders = {kernel.labels[to] for step in kernel.steps for to in (step.to, *step.targets) if to in kernel.labels}
    kernel.leaders |= set(kernel.functions.values())
    kernel.leaders |= {i + 1 for i, step in enumerate(kernel.steps) if step.op in ENDS}
    known, todo = {0: State(TOGETHER, {}, {}, {})}, [0]

    def flow(at, state):
        if at >= len(kernel.steps):
            return
        changed = at not in known or known[at].meet(state)
        known.setdefault(at, state.copy())
        if changed and at not in todo:
            todo.append(at)

    while todo:
        at = todo.pop()
        follow(kernel, at, known[at].copy(), flow)
    wrong = [step for at, state in known.items() for step in follow(kernel, at, state.copy(), lambda _at, _state: None)]
    return sorted(set(wrong), key=lambda step: step.at)


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
    bad = len({kernel.name for kernel, _ in found})
    print(f"{name}: {len(kernels)} kernels, {asked} collectives and barriers, {len(found)} in {bad} kernels may find lanes apart")
    # Nothing found to look at is nothing proven.
    return 1 if found else 0 if asked else 2


if __name__ == "__main__":
    sys.exit(main())
