#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes a book of the pages in build/book, as EPUB and as PDF. Fails if Sphinx warns, LaTeX cannot set
# the book, epubcheck finds an error, or a picture is missing.
set -euo pipefail
cd "$(dirname "$0")/.."
book=build/book
rm -rf $book
mkdir -p $book/latex

version=$(sed -n 's/.*<version>\(.*\)<.*/\1/p' src/mrp/package.xml)

sphinx() {
  "$(tools/docs_env.sh)" -m sphinx -q -W --keep-going -D "version=$version" -d $book/doctrees \
    -b "$1" src/mrp/doc "$book/$1"
}

sphinx epub
sphinx latex
log=$book/latex/output.txt
env -C $book/latex latexmk -xelatex -interaction=nonstopmode -halt-on-error mrp.tex > $log 2>&1 || {
  tail -n 40 $log >&2
  echo "error: LaTeX cannot set the book; its own messages are above" >&2
  exit 1
}
# Debian's command epubcheck needs a kernel that starts .jar files; a container's often does not.
java -jar /usr/share/java/epubcheck.jar --quiet --error $book/epub/mrp.epub

wanted=$(grep -rhE '^ *\.\. (ros-graph|timeline|queue)::' src/mrp/doc/pages | wc -l)
in_epub=$(find $book/epub -name '*.xhtml' -exec cat {} + | grep -o '<img' | wc -l)
in_pdf=$(grep -o 'includegraphics' $book/latex/mrp.tex | wc -l)
if [ "$in_epub" != "$wanted" ] || [ "$in_pdf" != "$wanted" ]; then
  echo "error: expected $wanted pictures; the EPUB has $in_epub, and the PDF $in_pdf" >&2
  exit 1
fi
mv $book/epub/mrp.epub $book/latex/mrp.pdf $book/
