"""The stubs say what the module has: signatures, docstrings, choices; and the words of docstrings are plain.

`NEARMISS_BLESS=1` writes the module's docstrings into the stubs.
"""

import ast
import inspect
import os
import pydoc
import re
import textwrap
import types
from pathlib import Path

import pytest

import nearmiss as nm
from nearmiss import _native, errors, kinds, research, shortcuts

INSTALLED = Path(_native.__file__).parent / "_native.pyi"
SOURCE = Path(__file__).parents[1] / "lib" / "nearmiss" / "_native.pyi"


def members(tree):
    """Functions and classes of a stub by their names, and members of classes as `Class.name`."""
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name, node
        if isinstance(node, ast.ClassDef):
            for member in node.body:
                if isinstance(member, ast.FunctionDef):
                    yield f"{node.name}.{member.name}", member


def thing(name, module):
    """The part of a module with that name."""
    for part in name.split("."):
        module = function_of(vars(module)[part])
    return module


def function_of(part):
    """The function of a static method; other parts as they are."""
    return part.__func__ if isinstance(part, staticmethod) else part


def parameters(node):
    """Parameters of a stub's function: name, kind and default."""
    of, kind = node.args, inspect.Parameter
    value = lambda default: kind.empty if default is None else ast.literal_eval(default)
    positional = of.posonlyargs + of.args
    defaults = [None] * (len(positional) - len(of.defaults)) + of.defaults
    found = [(arg.arg, kind.POSITIONAL_OR_KEYWORD, value(default)) for arg, default in zip(positional, defaults)]
    if of.vararg:
        found.append((of.vararg.arg, kind.VAR_POSITIONAL, kind.empty))
    found += [(arg.arg, kind.KEYWORD_ONLY, value(default)) for arg, default in zip(of.kwonlyargs, of.kw_defaults)]
    return [one for one in found if one[0] not in ("self", "cls")]


def differences(text, module):
    """How a stub differs from its module: names, signatures, docstrings."""
    stubs = dict(members(ast.parse(text)))
    found = []
    classes = {name: kind for name, kind in vars(module).items() if inspect.isclass(kind) or callable(kind)}
    for name, kind in classes.items():
        own = [name] + [f"{name}.{n}" for n in (vars(kind) if inspect.isclass(kind) else ()) if not n.startswith("_")]
        found += [f"{part} is missing" for part in own if part not in stubs]
    for name, node in stubs.items():
        last = name.rsplit(".", 1)[-1]
        try:
            own = thing(name, module)
        except KeyError:
            if last != "__new__":
                found.append(f"{name} does not exist")
            continue
        if isinstance(node, ast.FunctionDef) and not node.decorator_list and (not last.startswith("__") or last == "__new__"):
            signature = inspect.signature(thing(name.split(".")[0], module) if last == "__new__" else own)
            given = [(p.name, p.kind, p.default) for p in signature.parameters.values() if p.name != "self"]
            given = [(n, inspect.Parameter.POSITIONAL_OR_KEYWORD if k is inspect.Parameter.POSITIONAL_ONLY else k, d) for n, k, d in given]
            if given != parameters(node):
                found.append(f"{name} takes {signature}")
        if not last.startswith("__") and ast.get_docstring(node) != inspect.getdoc(own):
            found.append(f"{name} has another docstring")
    return found


def with_docstrings(text, module):
    """The stub with the docstrings of the module."""
    lines = text.splitlines()
    for name, node in sorted(members(ast.parse(text)), key=lambda of: -of[1].lineno):
        last = name.rsplit(".", 1)[-1]
        if last.startswith("__"):
            continue
        own = inspect.getdoc(thing(name, module))
        indent = " " * (node.col_offset + 4)
        body = node.body[0]
        is_doc = isinstance(body, ast.Expr) and isinstance(getattr(body.value, "value", None), str)
        docstring = textwrap.indent(f'"""{own}"""' if "\n" not in own else f'"""{own}\n"""', indent, lambda line: line.strip() != "")
        if is_doc:
            lines[body.lineno - 1 : body.end_lineno] = docstring.splitlines()
        elif isinstance(body, ast.Expr) and lines[body.lineno - 1].rstrip().endswith(": ..."):
            head = lines[body.lineno - 1].rstrip()[: -len(" ...")]
            lines[body.lineno - 1 : body.lineno] = [head, *docstring.splitlines()]
        else:
            # A class with members.
            lines[body.lineno - 1 - len(body_decorators(body)) : body.lineno - 1 - len(body_decorators(body))] = [*docstring.splitlines(), ""]
    return "\n".join(lines) + "\n"


def body_decorators(node):
    """Decorators of a member, each of which is a line before it."""
    return getattr(node, "decorator_list", [])


def test_the_stubs_say_what_there_is():
    if os.environ.get("NEARMISS_BLESS"):
        SOURCE.write_text(with_docstrings(SOURCE.read_text(), _native))
        return
    assert differences(INSTALLED.read_text(), _native) == []


PLANTED = '''
class Body:
    """A body."""
    def __new__(cls, vertices, *, kind="rigid"): ...
    def weigh(self, by: float = 1.0) -> float:
        """Return the weight."""
    @staticmethod
    def of(text: str) -> Body:
        """Return the body of a text."""
'''


def planted():
    """A module that is a little other than its stub."""
    module = types.ModuleType("planted")
    exec('class Body:\n    """A body."""\n    def __new__(cls, vertices, *, kind="rigid"): ...\n'
         '    def weigh(self, by=1.0):\n        """Return the weight."""\n'
         '    @staticmethod\n    def of(text):\n        """Return the body of a text."""', vars(module))
    vars(module).pop("__builtins__", None)
    return module


@pytest.mark.parametrize("change, fault", [
    (("", ""), None),
    (("by: float = 1.0", "by: float = 2.0"), "Body.weigh takes (self, by=1.0)"),
    (("by: float", "mass: float"), "Body.weigh takes (self, by=1.0)"),
    (("*, kind", "kind"), "Body.__new__ takes (vertices, *, kind='rigid')"),
    (("the weight", "a weight"), "Body.weigh has another docstring"),
    (("A body.", "Body."), "Body has another docstring"),
    (("of a text", "of text"), "Body.of has another docstring"),
    (("weigh", "weight_of"), "Body.weigh is missing"),
    (("class Body", "class Cloth"), "Body is missing"),
])
def test_a_stub_that_says_something_else_is_noticed(change, fault):
    found = differences(PLANTED.replace(*change), planted())
    assert (found == []) if fault is None else fault in found


def test_docstrings_are_written_into_stubs():
    bare = re.sub(r'\n *"""(A body|Return the weight|Return the body of a text)\."""', "", PLANTED)
    bare = bare.replace("-> float:", "-> float: ...").replace("-> Body:", "-> Body: ...")
    assert bare.count('"""') == 0 and differences(bare, planted()) != []
    for text in (bare, PLANTED.replace("the weight", "nothing"), PLANTED):
        blessed = with_docstrings(text, planted())
        assert differences(blessed, planted()) == [] and with_docstrings(blessed, planted()) == blessed


# Choices.


def literals(node):
    """Names of choices of the parameters of a stub's function."""
    for arg in node.args.args + node.args.kwonlyargs:
        for part in ast.walk(arg.annotation) if arg.annotation else []:
            if isinstance(part, ast.Subscript) and getattr(part.value, "id", None) == "Literal":
                elements = part.slice.elts if isinstance(part.slice, ast.Tuple) else [part.slice]
                names = {element.value for element in elements if isinstance(element.value, str)}
                if names:
                    yield arg.arg, names


def listed(call):
    """Names that a refusal lists."""
    with pytest.raises(nm.InvalidArgumentError) as told:
        call()
    return set(re.findall(r'"([^"]*)"', str(told.value).split("; ", 1)[1]))


def choices():
    """Names of choices by function and parameter, as refusals list them."""
    vertices, faces = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
    yield ("Device.__new__", "backend"), listed(lambda: nm.Device("x"))
    yield ("Body.__new__", "kind"), listed(lambda: nm.Body(vertices, faces, kind="x"))
    queries = [nm.Discrete(), nm.Continuous(), nm.Near(1)]
    yield ("configure", "solver"), set().union(*(listed(lambda: research.configure(q, solver="x")) for q in queries))
    body, cpu = nm.Body(vertices, faces), nm.Device("cpu")
    for own in (nm.Detector(body, device=cpu), nm.MultiDetector(body, [cpu, cpu])):
        name = type(own).__name__
        found = own.query(nm.Near(1))
        yield (f"{name}.grouped", "by"), listed(lambda: own.grouped(found, 0, "x"))
        yield (f"{name}.prepare", "grouped"), listed(lambda: own.prepare({}, [nm.Near(1)], grouped=["x"]))
    own, none = nm.Detector(body, device=cpu), [[]] * 3
    yield ("Detector.prepare_poses", "grouped"), listed(lambda: own.prepare_poses(*none, [nm.Near(1)], grouped=["x"]))
    for name in ["broad_phase", "bounding_volume", "rebuild"]:
        yield ("configure", name), listed(lambda: research.configure(nm.Near(1), **{name: "x"}))


def wrong_choices(text, known):
    """Parameters whose choices in a stub are others."""
    found = {(name, arg): names for name, node in members(ast.parse(text)) if isinstance(node, ast.FunctionDef) for arg, names in literals(node)}
    return sorted({key for key in known.keys() | found.keys() if known.get(key) != found.get(key)})


def test_editors_show_every_choice():
    text, known = INSTALLED.read_text(), dict(choices())
    assert len(known) == 11 and wrong_choices(text, known) == []


def test_a_choice_that_is_missing_is_noticed():
    text, known = INSTALLED.read_text(), dict(choices())
    for name, key in [("rigid", ("Body.__new__", "kind")), ("cuda", ("Device.__new__", "backend")), ("manual", ("configure", "rebuild")),
                      ("corner", ("Detector.prepare", "grouped"))]:
        assert key in wrong_choices(text.replace(f'"{name}"', '"other"'), known)


# Names that were.

OLD = set("""
fra-me det-ect fet-ch sepa-ration bud-get self_con-tact toi-_hi indi-ces degr-aded unre-solved Choice-Error CON-TACT
UNRE-SOLVED bro-ad b-v a b w-0 tri-_a ear-liest_query
""".replace("-", "").split())
"""Names that nothing has any more. They are divided so that a search for one finds nothing."""

OLD_CHOICES = ['con-tact', 'unre-solved', 'degr-aded', 'sta-tic', 'self-con-tact', 'as-ked', 'wo-rn', 'ne-ver']


def names(module):
    """Every public name of a module: its own, those of classes, and those of parameters."""
    for name, own in vars(module).items():
        if name.startswith("_"):
            continue
        yield name
        parts = [own]
        if inspect.isclass(own):
            parts += [part for member, part in vars(own).items() if not member.startswith("_")]
            yield from (member for member in vars(own) if not member.startswith("_"))
        for part in parts:
            try:
                yield from inspect.signature(part).parameters
            except (TypeError, ValueError):
                continue


def test_old_names_are_gone():
    found = {name for module in (nm, _native, errors, kinds, research, shortcuts) for name in names(module)}
    assert len(found) > 150 and {"min_separation", "toi_upper", "feature_a", "caveats"} <= found
    assert found & OLD == set()
    for text in OLD_CHOICES:
        assert f'"{text.replace("-", "")}"' not in INSTALLED.read_text()


def test_an_old_name_is_noticed():
    module = types.ModuleType("planted")
    frame, separation, contact = ("".join(parts) for parts in [("fra", "me"), ("sepa", "ration"), ("CON", "TACT")])
    text = f"class Detector:\n    def {frame}(self): ...\n    def near(self, {separation}=0): ...\nclass Status:\n    {contact} = 0"
    exec(text, vars(module))
    assert set(names(module)) & OLD == {frame, separation, contact}


# Words.

BANNED = [
    "the seed", "anew", "hangs on", "mend", "beside", "ask", "asks", "asked", "tell", "tells", "told", "worn", "lent", "guess",
    "whoever", "whatever", "nobody", "where it lies",
]
OPENINGS = ["What", "Of", "Who", "Whose", "Where", "Which", "How"]
LONGEST = 25


def docstrings():
    """Docstrings of everything public, by name."""
    yield "nearmiss", nm.__doc__
    for module in (_native, errors, kinds, research, shortcuts):
        yield module.__name__, inspect.getdoc(module)
        for name, own in vars(module).items():
            if name.startswith("_") or not (inspect.isclass(own) or callable(own)) or not str(getattr(own, "__module__", "")).startswith("nearmiss"):
                continue
            yield name, inspect.getdoc(own)
            if inspect.isclass(own):
                for member, part in vars(own).items():
                    if not member.startswith("_") and not isinstance(part, int):
                        yield f"{name}.{member}", inspect.getdoc(function_of(part))


def badly_worded(name, text):
    """Faults of a docstring."""
    if not text:
        return [f"{name}: no docstring"]
    first = text.split("\n")[0]
    found = [] if first.endswith((".", ":")) or name == "nearmiss" else [f"{name}: the first line is no sentence: {first}"]
    prose = re.sub(r"^    .*$", "", text, flags=re.M)
    parts = [" ".join(part.split()) for part in re.split(r"\n\s*\n|\n- ", prose)]
    for sentence in (s for part in parts for s in re.split(r"(?<=[.!?:;]) ", part)):
        words = sentence.split()
        if len(words) > LONGEST:
            found.append(f"{name}: {len(words)} words: {sentence}")
        if words and words[0].strip("`") in OPENINGS:
            found.append(f"{name}: begins with {words[0]}: {sentence}")
        found += [f"{name}: {word}: {sentence}" for word in BANNED if re.search(rf"\b{word}\b", sentence.lower())]
    return found + [f"{name}: {len(line)} columns" for line in text.split("\n") if len(line) > 130]


def test_docstrings_are_worded_plainly():
    all_of_them = list(docstrings())
    assert len(all_of_them) > 120
    assert [fault for name, text in all_of_them for fault in badly_worded(name, text)] == []


def test_bad_wording_is_noticed():
    for text, fault in [
        (None, "no docstring"), ("", "no docstring"), ("a thing", "no sentence"), ("What it is.", "begins with What"),
        ("A thing. Where it is short it grows.", "begins with Where"), ("A thing that is asked.", "asked"),
        ("A thing.\n\n- `x`: of the seed.", "the seed"), ("word " * 25 + "word.", "26 words"),
    ]:
        assert any(fault in found for found in badly_worded("x", text)), text
    assert badly_worded("x", "Number of things.\n\n- `x`: a task, at least 1.\n\n    what = asked()") == []


def test_help_begins_with_the_functions():
    text = pydoc.plain(pydoc.render_doc(nm))
    description = text.split("DESCRIPTION", 1)[1]
    functions = ["self_intersections(", "near(", "contacts(", "time_of_impact(", "read_mesh("]
    at = [description.index(name) for name in functions]
    assert at == sorted(at) and max(at) < description.index("Detector(scene)") and at[0] < 200
