"""Rules that make code wrong: each rule replaces tokens of a function by other text.

A rule does not depend on how a file is laid out. It names a file, optionally a function, and a pattern of C++ or GLSL
tokens that must occur exactly once there. White space and comments do not count.
"""
import dataclasses
import re
import tomllib

TOKEN = re.compile(r'''
    (?P<skip>\s+ | //[^\n]* | /\*.*?\*/)
  | (?P<token>R"(?P<mark>[^()\s]*)\(.*?\)(?P=mark)" | "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])+'
      | \.?[0-9](?:[eEpP][+-]|[0-9a-zA-Z_.'])* | [A-Za-z_]\w*
      | <<= | >>= | <=> | \.\.\. | ->\* | :: | -> | \+\+ | -- | << | <= | >= | == | != | && | \|\| | [-+*/%&|^]= | \#\# | .)
''', re.VERBOSE | re.DOTALL)


class RuleError(Exception):
    """A rule that does not fit the code; the text names rule, file and what was found."""


@dataclasses.dataclass
class Edit:
    """One replacement: in `file`, within `function` if given, the tokens of `find` become the text `replace`."""
    file: str
    find: str
    replace: str
    function: str = ""


@dataclasses.dataclass
class Rule:
    """A rule: what is wrong, the edits, and either the tests (`program filter`) or the stress row that must fail."""
    name: str
    wrong: str
    edits: list[Edit]
    test: str = ""
    row: str = ""


def tokens(text):
    """Returns the tokens of C++ or GLSL text as (token, begin, end), without white space and comments."""
    return [(match["token"], match.start(), match.end()) for match in TOKEN.finditer(text) if match["token"]]


def closing(listed, begin):
    """Returns the index of the bracket that closes the one at `begin`, or the number of tokens if none does."""
    depth = 0
    for i in range(begin, len(listed)):
        depth += (listed[i][0] in "([{") - (listed[i][0] in ")]}")
        if depth == 0:
            return i
    return len(listed)


def bodies(listed, function):
    """Returns the token ranges (first, end) of all definitions of a function, from its name to its closing brace.

    A definition is the name, a list in parentheses and then, before a semicolon, a block in braces.
    """
    found = []
    for i in range(len(listed) - 1):
        if listed[i][0] != function or listed[i + 1][0] != "(":
            continue
        k = closing(listed, i + 1) + 1
        while k < len(listed) and listed[k][0] not in ("{", ";", ")", ","):
            k = closing(listed, k) + 1 if listed[k][0] in "([" else k + 1
        if k < len(listed) and listed[k][0] == "{":
            found.append((i, closing(listed, k) + 1))
    return found


def find_all(text, pattern, function):
    """Returns the character ranges (begin, end) in `text` whose tokens are those of `pattern`."""
    listed, wanted = tokens(text), [token for token, _, _ in tokens(pattern)]
    ranges = bodies(listed, function) if function else [(0, len(listed))]
    found = {}
    for first, end in ranges:
        for i in range(first, end - len(wanted) + 1):
            if all(listed[i + k][0] == wanted[k] for k in range(len(wanted))):
                found[i] = (listed[i][1], listed[i + len(wanted) - 1][2])
    return list(found.values())


def apply(edit, text, name):
    """Returns `text` with the edit made. Raises RuleError unless its pattern occurs exactly once."""
    found = find_all(text, edit.find, edit.function)
    where = edit.file + (f", function {edit.function}" if edit.function else "")
    if len(found) != 1:
        raise RuleError(f"mutation '{name}': {where}: wanted `{' '.join(edit.find.split())}` once, "
                        f"found it {len(found)} times")
    (begin, end), = found
    return text[:begin] + edit.replace + text[end:]


def part(listed, number, count):
    """Returns the `number`th of `count` parts of the rules, in their order, because neighbours change the same files."""
    if not 1 <= number <= count:
        raise RuleError(f"wanted a part from 1/{count} to {count}/{count}, found '{number}/{count}'")
    ends = [len(listed) * i // count for i in (number - 1, number)]
    return dict(list(listed.items())[slice(*ends)])


def read(path):
    """Returns the rules of a TOML file by name. Raises RuleError for a rule without a test or an edit."""
    with open(path, "rb") as file:
        listed = tomllib.load(file)["mutation"]
    rules = {}
    for entry in listed:
        edits = [Edit(**edit) for edit in entry.pop("edits")]
        rule = Rule(edits=edits, **entry)
        if rule.name in rules or not edits or bool(rule.test) == bool(rule.row):
            raise RuleError(f"{path}: mutation '{rule.name}': wanted a name of its own, edits, and a test or a stress row")
        rules[rule.name] = rule
    return rules
