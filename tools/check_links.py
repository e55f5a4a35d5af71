"""Fails when a link of a Markdown page, or a path that it names in backticks, leads nowhere.

    check_links.py            all pages of the repository: files, headings (as GitHub names them), paths
    check_links.py FOLDER     a built site: every local link and anchor of its HTML pages
"""
import html.parser
import pathlib
import re
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent
LINK = re.compile(r"\[([^\]\[]+)\]\(([^)\s]+)\)")
# Doxygen 1.9.4 announces nested classes on the page of a class that has private ones alone, and lists none.
UNLISTED = "nested-classes"
PATH = re.compile(r"`((?:docs|tests|src|bench|tools|scripts|examples|schema|cmake)/[\w./-]+)`")


def pages() -> list[pathlib.Path]:
    folders = [ROOT / "docs", ROOT / "examples"]
    return sorted([*ROOT.glob("*.md"), *(p for f in folders for p in f.rglob("*.md"))])


def is_page(path: pathlib.Path) -> bool:
    return path.suffix == ".md" and path.is_file()


def outside_code(text: str):
    """Lines, and whether each is code: between fences, or indented behind a blank line."""
    fenced = indented = False
    before = ""
    for line in text.split("\n"):
        if line.lstrip().startswith("```"):
            fenced = not fenced
            yield line, True
        else:
            indented = line.startswith("    ") and (indented or not before.strip())
            yield line, fenced or indented
        before = line


def headings(text: str) -> list[str]:
    """Slugs in their order, repeated ones numbered."""
    seen: dict[str, int] = {}
    slugs = []
    for line, is_code in outside_code(text):
        match = None if is_code else re.match(r"#{1,6} +(.*?)(?: +#+)?$", line)
        if match:
            plain = LINK.sub(r"\1", match[1]).lower()
            slug = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")
            slugs.append(slug if slug not in seen else f"{slug}-{seen[slug]}")
            seen[slug] = seen.get(slug, 0) + 1
    return slugs


def page_defects(path: pathlib.Path) -> list[str]:
    found = []
    for number, (line, is_code) in enumerate(outside_code(path.read_text(encoding="utf-8")), 1):
        if is_code:
            continue
        place = f"{path.relative_to(ROOT)}:{number}"
        for _, target in LINK.findall(re.sub(r"`[^`]*`", "", line)):
            if re.match(r"\w+:", target):
                continue
            name, _, slug = target.partition("#")
            to = (path.parent / name).resolve() if name else path
            if not to.exists():
                found.append(f"{place}: {target} does not exist")
            elif slug and (not is_page(to) or slug not in headings(to.read_text(encoding="utf-8"))):
                found.append(f"{place}: {target}: there is no such heading")
        for target in PATH.findall(line):
            if "NNN" not in target and not (ROOT / target).exists():
                found.append(f"{place}: `{target}` does not exist")
    return found


class Html(html.parser.HTMLParser):
    """Links and anchors of a page."""

    def __init__(self, text: str):
        super().__init__()
        self.links: list[str] = []
        self.anchors: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.anchors.update(v for k in ("id", "name") if (v := values.get(k)))
        link = values.get("href") if tag in ("a", "link") else values.get("src")
        if link:
            self.links.append(link)


def site_defects(folder: pathlib.Path) -> list[str]:
    read = {p.resolve(): Html(p.read_text(encoding="utf-8")) for p in folder.rglob("*.html")}
    found = [] if read else [f"{folder}: no page"]
    for path, page in read.items():
        for link in page.links:
            url = urllib.parse.urlsplit(link)
            if url.scheme or url.netloc:
                continue
            to = (path.parent / urllib.parse.unquote(url.path)).resolve() if url.path else path
            anchor = urllib.parse.unquote(url.fragment)
            if not to.exists():
                found.append(f"{path.name}: {link} does not exist")
            elif anchor not in ("", UNLISTED) and to in read and anchor not in read[to].anchors:
                found.append(f"{path.name}: {link}: there is no such anchor")
    return found


def main() -> int:
    if len(sys.argv) > 1:
        defects = site_defects(pathlib.Path(sys.argv[1]))
    else:
        defects = [defect for page in pages() for defect in page_defects(page)]
    print("\n".join(defects) if defects else "links: as they should be")
    return 1 if defects else 0


if __name__ == "__main__":
    sys.exit(main())
