#!/usr/bin/env python3
"""Checks a built site: every link leads to a file and an anchor of it, and nothing is loaded from the network.

usage: check_site.py FOLDER"""
import html.parser
import pathlib
import re
import sys
import urllib.parse

# What a page loads by itself, as opposed to where its links lead.
LOADS = {("img", "src"), ("script", "src"), ("iframe", "src"), ("source", "src"), ("video", "src"), ("audio", "src")}
LOADING_LINKS = {"stylesheet", "icon", "preload", "prefetch", "preconnect", "dns-prefetch", "manifest"}


class Page(html.parser.HTMLParser):
    """The links, loads and anchors of a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.loads, self.anchors = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        for name in ("id", "name"):
            if attributes.get(name):
                self.anchors.add(attributes[name])
        if tag == "a" and attributes.get("href"):
            self.links.append(attributes["href"])
        for name, value in attributes.items():
            if (tag, name) in LOADS and value:
                self.loads.append(value)
        if tag == "link" and LOADING_LINKS & set(attributes.get("rel", "").split()):
            self.loads.append(attributes.get("href", ""))


def check(root):
    """Prints what is wrong, and returns how many places that are and how many links there are."""
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(root.rglob("*.html"))}
    wrong = links = 0
    for path, page in pages.items():
        where = path.relative_to(root)
        for target in page.links + page.loads:
            parts = urllib.parse.urlsplit(target)
            if parts.scheme or parts.netloc:
                if target in page.loads and parts.scheme != "data":
                    print(f"{where}: loads {target}")
                    wrong += 1
                continue
            links += 1
            if path.name == "404.html" and parts.path.startswith("/"):
                continue  # the page for unknown addresses counts from the site's root
            file = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if file.is_dir():
                file = file / "index.html"
            if not file.exists():
                print(f"{where}: {target} leads to nothing")
                wrong += 1
            elif parts.fragment and file in pages:
                fragment = urllib.parse.unquote(parts.fragment)
                if fragment not in pages[file].anchors and fragment != "__skip":
                    print(f"{where}: {target}: the page has no such anchor")
                    wrong += 1
    for path in sorted(root.rglob("*.css")):
        for target in re.findall(r"url\(\s*['\"]?([^'\")]+)", path.read_text(encoding="utf-8")):
            if re.match(r"(https?:)?//", target):
                print(f"{path.relative_to(root)}: loads {target}")
                wrong += 1
    return wrong, links, len(pages)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = pathlib.Path(sys.argv[1]).resolve()
    wrong, links, pages = check(root)
    if not pages:
        sys.exit(f"{root} holds no page")
    print(f"{pages} pages, {links} links: {wrong} wrong")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
