"""Shows Doxygen what it would not see: comments of headers as documentation, and links of Markdown as its anchors.

    prepare.py FOLDER      writes what Doxygen is to read, line by line as it stands in the sources

Headers: the comment in front of a declaration and the one behind it, on its line, are its documentation; the
comment at the head of a file is that of the file; one that a blank line follows belongs to nothing. Markdown:
headings get anchors of the form page-heading, so that links as GitHub understands them lead there; links to
files that are no page of the site become their paths, those to scripts of the gallery lead to their pages where it is
built (COAPT_GALLERY=yes), pictures are found by their names.
"""
import os
import pathlib
import re
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from check_links import LINK, headings, is_page, outside_code, pages  # noqa: E402

SPECIAL = re.compile(r"[\\@<>#%*_&|`\[\]]|-(?=-)")


def quoted(text: str) -> str:
    """A sentence of a comment, taken literally; what stands in backticks is code."""
    parts = text.split("`")
    if len(parts) % 2 == 0:
        parts = [text]
    return "".join(f"<tt>{SPECIAL.sub(escaped, part)}</tt>" if k % 2 else SPECIAL.sub(escaped, part)
                   for k, part in enumerate(parts))


def escaped(match: re.Match) -> str:
    return "\\" + match[0]


def comment_column(line: str) -> int:
    """Where the comment behind a declaration begins; -1 where there is none."""
    quotes = 0
    for k, sign in enumerate(line):
        if sign == '"' and line[k - 1] != "\\":
            quotes += 1
        if quotes % 2 == 0 and line.startswith("//", k):
            return k
    return -1


def block(bodies: list[str], is_head: bool) -> list[str]:
    """The comment of a declaration, or of a file. Lines set in by three blanks are formulas and tables."""
    out = ["/// @file"] if is_head else []
    is_set_in = False
    for body in [b for b in bodies if not b.startswith(" ---")]:
        if body.startswith("   ") != is_set_in:
            is_set_in = not is_set_in
            out.append("/// @code{.unparsed}" if is_set_in else "/// @endcode")
        out.append("///" + body if is_set_in else "/// " + quoted(body.strip()))
    return out + (["/// @endcode"] if is_set_in else [])


def documented(text: str) -> str:
    lines = text.split("\n")
    out: list[str] = []
    column = -1  # of the comment behind the declaration above
    k = 0
    while k < len(lines):
        at = comment_column(lines[k])
        if at < 0:
            column = -1
            out.append(lines[k])
            k += 1
        elif lines[k][:at].strip():
            out.append(lines[k][:at] + "///< " + quoted(lines[k][at + 2:].strip()))
            column = at
            k += 1
        elif at == column:
            out.append(" " * at + "///< " + quoted(lines[k][at + 2:].strip()))
            k += 1
        else:
            end = k
            while end < len(lines) and lines[end].lstrip().startswith("//"):
                end += 1
            is_head = k == 0
            is_loose = end < len(lines) and not lines[end].strip()
            if is_loose and not is_head:
                out += [""] * (end - k)
            else:
                out += block([line.strip()[2:] for line in lines[k:end]], is_head)
            column = -1
            k = end
    return "\n".join(out)


def anchor(path: pathlib.Path, slug: str) -> str:
    page = re.sub(r"\W+", "-", str(path.relative_to(ROOT).with_suffix(""))).lower()
    return f"{page}-{slug}"


def plain(line: str) -> str:
    """A line of a page in which nothing outside of backticks is a command or a tag to Doxygen."""
    parts = line.split("`")
    parts[::2] = [re.sub(r"(?=[@\\]\w|</?\w)", r"\\", part) for part in parts[::2]]
    return "`".join(parts)


def page_text(path: pathlib.Path, text: str) -> str:
    names = iter(headings(text))

    def rewritten(match: re.Match) -> str:
        label, target = match[1], match[2]
        if match.start() > 0 and match.string[match.start() - 1] == "!":  # Doxygen looks for pictures by name
            return f"[{label}]({pathlib.Path(target).name})"
        if re.match(r"\w+:", target):
            return match[0]
        name, _, slug = target.partition("#")
        to = (path.parent / name).resolve() if name else path
        if to.parent == ROOT / "docs/gallery" and to.suffix == ".py" and os.environ.get("COAPT_GALLERY") == "yes":
            return f'<a href="gallery/pages/{to.stem}.html">{label}</a>'
        if not is_page(to):
            return f"{label} (<tt>{to.relative_to(ROOT)}</tt>)" if label != name else f"<tt>{name}</tt>"
        return f"[{label}](@ref {anchor(to, slug or 'page')})"

    out = []
    first = True
    for line, is_code in outside_code(text):
        if is_code:
            out.append(line)
            continue
        line = LINK.sub(rewritten, plain(line))
        if re.match(r"#{1,6} ", line):
            slug = next(names)
            line = f"{line} {{#{anchor(path, 'page' if first else slug)}}}"
            first = False
        out.append(line)
    return "\n".join(out)


def sources() -> list[pathlib.Path]:
    """Pages, and the headers that are installed."""
    headers = [p for p in (ROOT / "src").rglob("*.hpp") if not {"detail", "formats", "cli"} & set(p.parts)]
    return [*pages(), *sorted(headers)]


def main(folder: pathlib.Path) -> None:
    shutil.rmtree(folder, ignore_errors=True)
    for path in sources():
        text = path.read_text(encoding="utf-8")
        copy = folder / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(page_text(path, text) if path.suffix == ".md" else documented(text), encoding="utf-8")


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]))
