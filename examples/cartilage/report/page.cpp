// SPDX-License-Identifier: BSD-3-Clause
#include "cartilage/report/page.hpp"

#include "cartilage/report/html.hpp"

namespace cartilage {

namespace {

constexpr char const* style = R"(
:root { color-scheme: light; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 76rem; padding: 1.5rem 1.25rem 4rem; background: #fff; color: #1d2129;
  font: 1rem/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; overflow-wrap: anywhere; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0.5rem 0; }
h2 { font-size: 1.35rem; line-height: 1.25; margin: 3rem 0 0.5rem; padding-top: 1rem; border-top: 1px solid #e3e6ea; }
p, li { max-width: 46rem; }
.lead { color: #4a5260; margin-top: 0; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 30rem), 1fr)); gap: 2rem 2.5rem; }
figure { margin: 0; min-width: 0; }
figure img { display: block; width: 100%; max-width: 560px; height: auto; }
figure h3 { font-size: 1.05rem; margin: 0 0 0.35rem; }
figcaption { font-size: 0.925rem; color: #363d49; max-width: 560px; margin-top: 0.4rem; }
.scroll { overflow-x: auto; margin: 1rem 0; max-width: 100%; }
.scroll:focus-visible { outline: 2px solid #1a59bf; }
table { border-collapse: collapse; font-size: 0.925rem; font-variant-numeric: tabular-nums; overflow-wrap: normal; }
caption { text-align: left; color: #4a5260; padding-bottom: 0.4rem; }
th, td { text-align: left; padding: 0.35rem 0.9rem 0.35rem 0; border-bottom: 1px solid #e3e6ea; white-space: nowrap; }
.wrapped th, .wrapped td { white-space: normal; padding-right: 0.7rem; }
thead th { border-bottom: 2px solid #b9c0ca; font-weight: 600; vertical-align: bottom; }
tbody th { font-weight: 600; }
pre { overflow-x: auto; background: #f6f7f9; border-radius: 6px; padding: 0.8rem 1rem; font-size: 0.85rem;
  line-height: 1.45; max-width: 100%; }
)";

} // namespace

std::string page_head(std::string const& title) {
    std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
                       // The browser itself refuses external resources.
                       "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
                       "style-src 'unsafe-inline'\">\n"
                       "<title>";
    text += html_text(title) + "</title>\n<style>" + style;
    return text + "</style>\n</head>\n<body>\n";
}

std::string page_end() { return "</body>\n</html>\n"; }

std::string html_paragraph(std::string const& plain, char const* kind) {
    return "<p" + (*kind != '\0' ? " class=\"" + std::string(kind) + "\"" : std::string()) + ">" + html_text(plain) +
           "</p>\n";
}

std::string html_heading(std::string const& plain) { return "<h2>" + html_text(plain) + "</h2>\n"; }

} // namespace cartilage
