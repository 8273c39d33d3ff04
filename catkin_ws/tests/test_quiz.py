# SPDX-License-Identifier: BSD-3-Clause
"""The questions of the pages, as a learning platform gets them: a package in the format QTI 2.1."""

import xml.etree.ElementTree as ElementTree
import zipfile

import pytest

# One worker of pytest builds the site for these tests and for those of what the pages show.
pytestmark = [pytest.mark.slow, pytest.mark.xdist_group("page")]

QTI = "{http://www.imsglobal.org/xsd/imsqti_v2p1}"
PACKAGE = "{http://www.imsglobal.org/xsd/imscp_v1p1}"
STEPS = ("run", "talk", "listen", "cpp", "launch", "look", "check_it")


@pytest.fixture(scope="module")
def package(site):
    with zipfile.ZipFile(site / "quiz.zip") as archive:
        return {name: ElementTree.fromstring(archive.read(name)) for name in archive.namelist()}


def test_manifest_lists_every_item_and_nothing_else(package):
    manifest = package.pop("imsmanifest.xml")
    resources = [resource.attrib for resource in manifest.iter(f"{PACKAGE}resource")]
    assert {resource["href"] for resource in resources} == set(package)
    assert {resource["type"] for resource in resources} == {"imsqti_item_xmlv2p1"}


def test_each_step_has_two_to_four_questions(package):
    of_page = [name.split("-")[0] for name in package if name != "imsmanifest.xml"]
    assert set(of_page) == set(STEPS)
    assert all(2 <= of_page.count(page) <= 4 for page in STEPS)


def test_each_item_has_one_right_answer_and_says_why_to_each(package):
    for name, item in package.items():
        if name == "imsmanifest.xml":
            continue
        (right,) = [value.text for value in item.iter(f"{QTI}value")]
        choices = list(item.iter(f"{QTI}simpleChoice"))
        identifiers = [choice.get("identifier") for choice in choices]
        assert right in identifiers and len(set(identifiers)) == len(choices) > 1, name
        for choice in choices:
            feedback = choice.find(f"{QTI}feedbackInline")
            assert choice.text.strip() and feedback.text.strip(), name
            assert feedback.get("identifier") == choice.get("identifier"), name
        # The parts stand in the order that the schema of QTI 2.1 gives.
        parts = [part.tag.removeprefix(QTI) for part in item]
        assert parts == [
            "responseDeclaration",
            "outcomeDeclaration",
            "outcomeDeclaration",
            "itemBody",
            "responseProcessing",
        ]
