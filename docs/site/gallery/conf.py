"""The gallery of the site: scripts of docs/gallery, executed, with their pictures. scripts/docs runs it; no network."""
import os

from sphinx_gallery.sorting import FileNameSortKey

project = "Coapt"
version = release = os.environ["COAPT_VERSION"]
root_doc = "pages/index"
exclude_patterns = ["scripts"]
extensions = ["sphinx_gallery.gen_gallery"]
html_theme = "alabaster"
html_theme_options = {"description": "Closed, loaded equilibria of thin membranes", "page_width": "76rem",
                      "body_max_width": "none", "font_family": "sans-serif", "code_font_size": "0.8em"}
html_sidebars = {"**": ["about.html", "navigation.html", "searchbox.html"]}
html_copy_source = False
html_show_sphinx = html_show_copyright = False
sphinx_gallery_conf = {
    "examples_dirs": "scripts",
    "gallery_dirs": "pages",
    "filename_pattern": r"/plot_",
    "within_subsection_order": FileNameSortKey,
    "capture_repr": ("_repr_html_", "__repr__"),
    "ignore_repr_types": "matplotlib",
    "abort_on_example_error": True,  # an example that fails is no page
    "download_all_examples": False,
    "show_memory": False,
    "min_reported_time": 1e9,  # times differ from run to run
    "remove_config_comments": True,
}
