# SPDX-License-Identifier: MIT
"""Is a JSON value what a schema says? The part of JSON Schema 2020-12 that the schemas of this repository use, with the standard library
alone; any other keyword is an error of the schema, so that nothing is passed over in silence."""
import re

ANNOTATIONS = {"$schema", "$id", "$defs", "title", "description", "default"}
TYPES = {
    "object": lambda value: isinstance(value, dict),
    "array": lambda value: isinstance(value, list),
    "string": lambda value: isinstance(value, str),
    "boolean": lambda value: isinstance(value, bool),
    "number": lambda value: isinstance(value, (int, float)) and not isinstance(value, bool),
    "integer": lambda value: isinstance(value, int) and not isinstance(value, bool),
    "null": lambda value: value is None,
}


def same(a, b):
    """JSON's equality: 1 is not true."""
    return a == b and isinstance(a, bool) == isinstance(b, bool)


def faults(value, schema, root=None, place=""):
    """Texts, each with its JSON pointer; none: the value is valid. `root` holds the $defs (default: the schema itself)."""
    root = schema if root is None else root
    if schema is True:
        return
    for keyword, wanted in schema.items():
        if keyword in ANNOTATIONS:
            continue
        if keyword not in RULES:
            raise ValueError(f"the schema's keyword {keyword} at {place or '/'} is not known here")
        yield from RULES[keyword](value, wanted, schema, root, place)


def reference(value, wanted, _, root, place):
    yield from faults(value, root["$defs"][wanted.removeprefix("#/$defs/")], root, place)


def kind(value, wanted, _, __, place):
    if not any(TYPES[name](value) for name in ([wanted] if isinstance(wanted, str) else wanted)):
        yield f"{place or '/'} is no {wanted}"


def branches(value, wanted, root, place):
    return [list(faults(value, branch, root, place)) for branch in wanted]


def any_of(value, wanted, _, root, place):
    found = branches(value, wanted, root, place)
    if all(found):
        yield f"{place or '/'} is none of what is allowed: " + "; or ".join(texts[0] for texts in found)


def one_of(value, wanted, _, root, place):
    found = branches(value, wanted, root, place)
    if sum(not texts for texts in found) > 1:
        yield f"{place or '/'} is more than one of what is allowed"
    yield from any_of(value, wanted, _, root, place)


def all_of(value, wanted, _, root, place):
    for branch in wanted:
        yield from faults(value, branch, root, place)


def negation(value, wanted, _, root, place):
    if not list(faults(value, wanted, root, place)):
        yield f"{place or '/'} is what is not allowed"


def properties(value, wanted, _, root, place):
    for key in wanted.keys() & value.keys() if isinstance(value, dict) else ():
        yield from faults(value[key], wanted[key], root, f"{place}/{key}")


def patterns(value, wanted, _, root, place):
    for key in value if isinstance(value, dict) else ():
        for pattern, schema in wanted.items():
            if re.search(pattern, key):
                yield from faults(value[key], schema, root, f"{place}/{key}")


def additional(value, wanted, schema, root, place):
    for key in value.keys() - schema.get("properties", {}).keys() if isinstance(value, dict) else ():
        if any(re.search(pattern, key) for pattern in schema.get("patternProperties", {})):
            continue
        if wanted is False:
            yield f"{place}/{key} is an unknown key"
        else:
            yield from faults(value[key], wanted, root, f"{place}/{key}")


def names(value, wanted, _, root, place):
    for key in value if isinstance(value, dict) else ():
        yield from faults(key, wanted, root, f"{place}/{key}")


def items(value, wanted, _, root, place):
    for index, item in enumerate(value if isinstance(value, list) else ()):
        yield from faults(item, wanted, root, f"{place}/{index}")


def holds(condition, text):
    """A rule of one comparison; values of other types are the rule `type`'s business."""
    def rule(value, wanted, _, __, place):
        if not condition(value, wanted):
            yield f"{place or '/'} is not {text} {wanted}"
    return rule


def number(condition):
    return lambda value, wanted: not TYPES["number"](value) or condition(value, wanted)


RULES = {
    "$ref": reference, "type": kind, "anyOf": any_of, "oneOf": one_of, "allOf": all_of, "not": negation,
    "properties": properties, "patternProperties": patterns, "additionalProperties": additional, "propertyNames": names, "items": items,
    "required": lambda value, wanted, _, __, place: (
        f"{place}/{key} is missing" for key in wanted if isinstance(value, dict) and key not in value),
    "const": holds(same, "equal to"),
    "enum": holds(lambda value, wanted: any(same(value, one) for one in wanted), "one of"),
    "minimum": holds(number(lambda value, wanted: value >= wanted), "at least"),
    "maximum": holds(number(lambda value, wanted: value <= wanted), "at most"),
    "exclusiveMinimum": holds(number(lambda value, wanted: value > wanted), "more than"),
    "minItems": holds(lambda value, wanted: not isinstance(value, list) or len(value) >= wanted, "a list of at least"),
    "maxItems": holds(lambda value, wanted: not isinstance(value, list) or len(value) <= wanted, "a list of at most"),
    "minLength": holds(lambda value, wanted: not isinstance(value, str) or len(value) >= wanted, "a text of at least"),
    "pattern": holds(lambda value, wanted: not isinstance(value, str) or re.search(wanted, value), "of the pattern"),
}
