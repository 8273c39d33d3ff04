#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Shows where the sentences of the pages, the quotes in tests and the lists do not fit together.

Usage: quote_claims.py show|write|ran

`show` prints each of them, with both texts and what to do.

`write` puts the sentences of the checked pages into the tests that they name, and all others into
the lists in src/mrp/doc/unproved. There a sentence that has changed keeps its reason, and a new one
that claims something gets the reason "open". Each change is printed, old and new: look whether the
test still proves what it quotes now, and whether the reason is right.

`ran` prints each proof that has not passed in the last `make test-all`. It leaves out what only a
machine with containers can run, and the tests of `make test-check`.

Exit code: 1 if `show` or `ran` prints such a thing.
"""

import ast
import json
import re
import subprocess
import sys
import textwrap

import pages
from pages import claims, evidence

_WIDTH = 100
_RUFF = evidence.WORKSPACE / "build" / "lint" / "bin" / "ruff"
_IMPORT = "from mrp_testing.proves import proves"


def wanted_quotes(sentences):
    """Return proof -> what it is to quote, in the order of reading, of each test to be changed.

    That is each sentence of a checked page that names the test, and what it quotes already of
    another page.
    """
    tests = evidence.all_tests()
    wanted = {proof: {} for proof, test in tests.items() if test.quotes}
    for one in sentences:
        for proof in one.proofs:
            known = proof in tests and one.text in tests[proof].quotes
            if proof in tests and one.typed and (known or one.page not in pages.NOT_CHECKED):
                wanted.setdefault(proof, {})[one.text] = True
    return {
        proof: tuple(quotes)
        for proof, quotes in wanted.items()
        if set(quotes) != set(tests[proof].quotes)
    }


def write_quotes(proof, test, quotes):
    """Write quotes into a test's file in place of those that it has."""
    write = {".py": in_python, ".cpp": in_cpp, ".patch": in_patch}[test.path.suffix]
    test.path.write_text(write(test.path.read_text(), proof.split("/")[-1], quotes))


def in_python(text, case, quotes):
    """Return a test file's text with these quotes above a test case, and with the import."""
    tree = ast.parse(text)
    lines = text.splitlines()
    functions = (node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))
    function = next(node for node in functions if node.name == case)
    first = min([function.lineno, *(one.lineno for one in function.decorator_list)])
    for old in reversed([one for one in function.decorator_list if evidence.is_proves(one)]):
        del lines[old.lineno - 1 : old.end_lineno]
    indent = " " * function.col_offset
    width = _WIDTH - len(f'{indent}    "" ,')
    new = [f"{indent}@proves("]
    for quote in quotes:
        # A quotation mark is written as two characters.
        *parts, last = _wrapped(quote, width - quote.count('"'))
        new += [f"{indent}    {json.dumps(part + ' ', ensure_ascii=False)}" for part in parts]
        new.append(f"{indent}    {json.dumps(last, ensure_ascii=False)},")
    if len(new) == 2 and len(new[1]) < width:
        new = [new[0] + new[1].strip().rstrip(",") + ")"]
    else:
        new.append(f"{indent})")
    lines[first - 1 : first - 1] = new if quotes else []
    if _IMPORT not in lines:
        imports = [one for one in tree.body if isinstance(one, (ast.Import, ast.ImportFrom))]
        lines.insert(imports[-1].end_lineno, _IMPORT)
    return "\n".join(lines) + "\n"


def in_cpp(text, case, quotes):
    """Return a test file's text with these quotes above a test case."""
    match = next(one for one in evidence.CPP_CASE.finditer(text) if one.group(3) == case)
    comment = re.split(r"^// Proves:", match.group(1), flags=re.MULTILINE)[0]
    width = _WIDTH - len("// ")
    lines = [line for quote in quotes for line in _wrapped(f"Proves: {quote}", width, "  ")]
    comment += "".join(f"// {line}\n" for line in lines)
    return text[: match.start(1)] + comment + text[match.start(2) :]


def in_patch(text, _case, quotes):
    """Return a defect's text with these quotes in its head, below the field Says."""
    text = re.sub(r"^Proves:.*\n(?: .*\n)*", "", text, flags=re.MULTILINE)
    lines = [line for quote in quotes for line in _wrapped(f"Proves: {quote}", _WIDTH, "    ")]
    says = re.search(r"^Says:.*\n(?: .*\n)*", text, re.MULTILINE)
    return text[: says.end()] + "".join(f"{line}\n" for line in lines) + text[says.end() :]


def _wrapped(text, width, indent=""):
    return textwrap.wrap(
        text, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )


def wanted_list(sentences, listed):
    """Return the list of a page: sentence -> reason, of all its sentences without a proof."""
    mine = [one for one in sentences if one.typed and not one.proofs]
    gone = [text for text in listed if text not in {one.text for one in mine}]
    wanted = {}
    for one in mine:
        before = one.text if one.text in listed else claims.nearest(one.text, gone)
        gone = [text for text in gone if text != before]
        wanted[one.text] = listed.get(before) or first_reason(one)
    return wanted


def first_reason(sentence):
    """Return the reason with which a sentence comes into a list. Whoever writes looks at it."""
    if sentence.heading:
        return "heading"
    if sentence.text.endswith("?"):
        return "question"
    if sentence.page == "pages/why":
        return "entry"
    return "source" if sentence.linked else "open"


def _say(where, old, new):
    """Print what has changed in a file."""
    print(where)
    for sign, texts in (("-", set(old) - set(new)), ("+", set(new) - set(old))):
        for text in sorted(texts):
            print(f"  {sign} {text}")


def write(sentences):
    """Write all quotes and lists that differ, and print how."""
    tests = evidence.all_tests()
    changed = []
    for proof, quotes in wanted_quotes(sentences).items():
        _say(f"{tests[proof].file}: {proof.split('/')[-1]}", tests[proof].quotes, quotes)
        write_quotes(proof, tests[proof], quotes)
        changed.append(tests[proof].path)
    python = [path for path in changed if path.suffix == ".py"]
    if python and _RUFF.exists():
        config = ("--config", evidence.WORKSPACE / "pyproject.toml", "--quiet")
        for command in (("check", "--fix", "--select", "I"), ("format",)):
            options = ("--no-cache", *config, *python)
            # Its order of imports depends on the folder in which it runs: that of `make lint`.
            subprocess.run([_RUFF, *command, *options], cwd=evidence.ROOT, check=True)
    for page in dict.fromkeys(one.page for one in sentences):
        path = pages.LISTS / f"{claims.name_of(page)}.txt"
        listed = claims.read_list(path)
        mine = [one for one in sentences if one.page == page]
        wanted, order = wanted_list(mine, listed), [digits for _, digits in claims.order(mine)]
        if page not in pages.NOT_CHECKED and (wanted, order) != (listed, claims.read_order(path)):
            _say(path.relative_to(evidence.ROOT), listed, wanted)
            claims.write_list(path, page, wanted, order)


def show(sentences):
    """Print what does not fit together; return how much that is."""
    found = pages.faults(sentences)
    found += claims.moved(sentences, pages.LISTS, found)
    for fault in found:
        where = fault.where if isinstance(fault.where, str) else "{}, line {}".format(*fault.where)
        print(f"{where}: {fault.text(evidence.all_tests())}\n")
    print(f"{len(found)} faults. Not checked yet: {', '.join(pages.NOT_CHECKED) or 'no page'}.")
    return len(found)


def show_not_ran(sentences):
    """Print the proofs that have not passed in the last run; return how many."""
    proofs = {proof for one in sentences for proof in one.proofs}
    elsewhere = {proof for proof in proofs if proof.startswith("docker/") or _is_of_sets(proof)}
    passed = {proof for proof, good in evidence.last_results().items() if good}
    missing = proofs - elsewhere - passed
    for proof in sorted(missing):
        print(f"not passed: {proof}: {evidence.command_of(proof, evidence.all_tests()[proof])}")
    print(
        f"proofs: {len(proofs & passed)} passed, {len(missing)} have not passed in make test-all,"
    )
    print(f"        {len(elsewhere)} are run by make docker-containers or make test-check")
    return len(missing)


def _is_of_sets(proof):
    """Say whether a proof is a test of `make test-check`, by its mark or that of its file."""
    test = evidence.all_tests()[proof]
    marks = re.findall(r"\bmark\.(quick|slow|sets)\b", test.source)
    of_file = re.findall(r"^pytestmark = .*\bmark\.(\w+)", test.path.read_text(), re.MULTILINE)
    return "sets" in (marks or of_file)


ACTIONS = {"show": show, "write": write, "ran": show_not_ran}


def main(action):
    sentences, _, _ = pages.build()
    return 1 if ACTIONS[action](sentences) else 0


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in ACTIONS:
        sys.exit(__doc__)
    try:
        sys.exit(main(sys.argv[1]))
    except pages.PagesError as error:
        sys.exit(f"error: {error}")
