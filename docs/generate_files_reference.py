#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Makes docs/files.md, the reference of scene, design, part and process files, from their schemas.

Usage: generate_files_reference.py            writes docs/files.md beside this script
       generate_files_reference.py --check    exit code 1 if it is not what would be written (tests/docs_check asks so)
"""
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
REFERENCE = HERE / "files.md"
SCHEMAS = (("Scene", "core/scene_files/scene.schema.json"), ("Design", "design/reading/design.schema.json"),
           ("Part", "core/part_files/part.schema.json"), ("Process", "design/reading/process.schema.json"))
HEAD = """# Files: scene, design, part and process

<!-- Made by docs/generate_files_reference.py from the schemas: change those, then run it. -->

Every key of the four files that people write. An editor can check them with the same schemas
({links}).
What they mean together: [concepts.md](concepts.md); whole files: [examples/](../examples); how scenes are read, and the source paper's format:
[core/scene_files/README.md](../core/scene_files/README.md). All other files: [interface.md](interface.md#files).

A key in **bold** is required; `outer.inner` is a key of an object inside. A length is a number in the file's `units`, or a text with a unit
of its own: `"0.3mm"`. Any other number that has a dimension may also be such a text (`"2 N/mm"`, `"30deg"`). A text that begins with `=` is
a formula of the scene's `variables` and, in a design, of its parameters: `"= bore - 2 * gap"`. A formula may contain `+ - * / ^ ( )`,
`min max hypot abs sqrt sin cos tan asin acos atan atan2 exp log floor`, `if(a < b, x, y)` and `pi`. Dimensions are checked; a number without a
unit beside a quantity is in the file's unit (angles: degrees). Numbers that no design can move (counts, time steps, tolerances of the solver)
take formulas of variables that no parameter moves. An unknown key is refused, with the nearest known one.
"""


def text_of(schema):
    """A description as one line that a table can hold."""
    return re.sub(r"\s+", " ", schema.get("description", "")).replace("|", "\\|").replace("<", "&lt;")


def quoted(value):
    return f"`{json.dumps(value)}`".replace("|", "\\|")


class Reference:
    """One schema as a chapter. Definitions with keys of their own become sections, others are described where they are used."""

    def __init__(self, name, schema):
        self.name, self.schema, self.lines = name, schema, []

    def definition(self, schema):
        return self.schema["$defs"][schema["$ref"].rpartition("/")[2]] if "$ref" in schema else schema

    def anchor(self, name):
        return f"{self.name} {name.replace('_', ' ')}".lower().replace(" ", "-")

    def has_section(self, schema):
        """Of a definition: does it have keys, or alternatives that do?"""
        return "properties" in schema or any("properties" in self.definition(branch) for branch in self.branches(schema))

    def branches(self, schema):
        return schema.get("oneOf", schema.get("anyOf", []))

    def type_of(self, schema):
        """What a value may be, in a few words."""
        if "$ref" in schema:
            name = schema["$ref"].rpartition("/")[2]
            definition = self.definition(schema)
            if self.has_section(definition):
                return f"[{name.replace('_', ' ')}](#{self.anchor(name)})"
            return {"length": "length", "lengths": "3 lengths", "point": "3 lengths", "vector": "3 numbers", "positive": "number > 0",
                    "not_negative": "number >= 0", "number": "number"}.get(name) or self.type_of(definition)
        if "const" in schema:
            return quoted(schema["const"])
        if "enum" in schema:
            return ", ".join(quoted(value) for value in schema["enum"])
        if self.branches(schema):
            return " or ".join(dict.fromkeys(self.type_of(branch) for branch in self.branches(schema)))
        return self.plain_type(schema)

    def plain_type(self, schema):
        kind = schema.get("type", "object")
        if kind == "array":
            least, most = schema.get("minItems", 0), schema.get("maxItems")
            count = f"{least} x " if least == most else f"list ({least} or more) of " if least else "list of "
            item = self.type_of(schema["items"])
            return count + (f"({item})" if count and " or " in item else item)
        if kind == "object":
            inner = schema.get("additionalProperties")
            return f"by name: {self.type_of(inner)}" if isinstance(inner, dict) else "object" if "properties" in schema else "text"
        limits = {"minimum": ">=", "exclusiveMinimum": ">", "maximum": "<="}
        bounds = " and ".join(f"{sign} {schema[key]:g}" for key, sign in limits.items() if key in schema)
        return {"integer": "whole number", "boolean": "true or false", "string": "text"}.get(kind, kind) + (f" {bounds}" if bounds else "")

    def keys(self, schema, prefix=""):
        """Rows of a table; keys of objects inside follow as `outer.inner`."""
        for name, value in schema["properties"].items():
            key = f"`{prefix}{name}`"
            key = f"**{key}**" if name in schema.get("required", []) else key
            inner = [one for one in (value, *self.branches(value)) if one.get("type") == "object" and "properties" in one]
            default = quoted(value["default"]) if "default" in value else ""
            meaning = text_of(value) or ("" if self.has_section(self.definition(value)) else text_of(self.definition(value)))
            self.lines.append(f"| {key} | {self.type_of(value)} | {default} | {meaning} |")
            for one in inner:
                self.keys(one, f"{prefix}{name}.")

    def table(self, schema):
        self.lines += ["", "| key | value | default | |", "|---|---|---|---|"]
        self.keys(schema)

    def section(self, heading, schema):
        self.lines += ["", heading]
        if text_of(schema):
            self.lines += ["", text_of(schema)]
        if "properties" in schema:
            self.told(schema)
        for branch in self.branches(schema):
            if "properties" in branch:
                self.lines += ["", ": ".join(text for text in (self.title(branch), text_of(branch)) if text)]
                self.told(branch)

    def told(self, schema):
        """The keys of an object, and what holds of them together."""
        self.more_keys(schema)
        choices = self.choices(schema)
        if choices:
            self.lines += ["", f"{'Exactly' if 'oneOf' in schema else 'At least'} one of: " + ", ".join(f"`{key}`" for key in choices) + "."]
        self.table(schema)

    def choices(self, schema):
        """Keys of which one is expected."""
        return [key for branch in self.branches(schema) if "properties" not in branch for key in branch.get("required", [])]

    def more_keys(self, schema):
        """What has the keys of another definition besides says so."""
        others = [self.type_of(other) for other in schema.get("allOf", [])]
        if others:
            self.lines += ["", f"Besides these keys it has those of its {' and '.join(others)}."]

    def title(self, branch):
        """What tells an alternative from the others: its title, its type, or what is required."""
        if "title" in branch:
            return f"**{branch['title']}**"
        kind = branch["properties"].get("type", {})
        values = [kind["const"]] if "const" in kind else kind.get("enum", branch.get("required", []))
        values = values or self.choices(branch)
        return "**" + ", ".join(f"`{value}`" for value in values) + "**" if values else ""

    def chapter(self, file):
        self.section(f"## {self.name}", {key: value for key, value in self.schema.items() if key != "oneOf"})
        for name, definition in self.schema["$defs"].items():
            if self.has_section(definition):
                self.section(f"### {self.name}: {name.replace('_', ' ')}", definition)
        return self.lines


def reference():
    links, chapters = [], []
    for name, file in SCHEMAS:
        links.append(f"[{pathlib.Path(file).name}](../{file})")
        chapters += Reference(name, json.loads((HERE.parent / file).read_text())).chapter(file)
    return HEAD.format(links=", ".join(links)) + "\n".join(chapters) + "\n"


def main(arguments):
    text = reference()
    if "--check" not in arguments:
        REFERENCE.write_text(text)
    elif not REFERENCE.exists() or REFERENCE.read_text() != text:
        print("docs/files.md is not what the schemas say: run docs/generate_files_reference.py")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
