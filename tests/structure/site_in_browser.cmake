# SPDX-License-Identifier: BSD-3-Clause
#
# cmake -D SITE=<html folder> -D CHROMIUM=<program> -D SCRATCH=<folder> [-D ALL=ON] -P site_in_browser.cmake: opens
# pages of the documentation in headless Chromium, 390 pixels wide as on a phone and without a network. No page
# scrolls sideways, no picture is missing, every formula is drawn. Then it opens a page with each of these faults and
# must find them.

cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE "${SCRATCH}")
file(MAKE_DIRECTORY "${SCRATCH}")

# visit(pages): sets `report`, a JSON array with a record for each page, and `said`, the messages on the console.
function(visit)
  list(JOIN ARGN "\", \"" pages)
  file(WRITE "${SCRATCH}/frame.html" "<!DOCTYPE html><html><body style=\"margin:0\">
<iframe id=\"frame\" style=\"width:390px;height:900px;border:0\"></iframe><pre id=\"found\"></pre>
<script>
const frame = document.getElementById('frame');
// Number of elements that reach beyond the page and are not in a box that scrolls.
function cut(page) {
  const right = page.documentElement.clientWidth + 0.5;
  const scrolls = (e) => e && e !== page.body &&
    (page.defaultView.getComputedStyle(e).overflowX !== 'visible' || scrolls(e.parentElement));
  const kinds = '.title, .contents p, .contents li, .contents img, .contents table, .contents svg';
  return [...page.querySelectorAll(kinds)].filter(
    (e) => e.getBoundingClientRect().right > right && !scrolls(e.parentElement)).length;
}
async function visit(url) {
  await new Promise((done) => { frame.onload = done; frame.src = url; });
  const page = frame.contentDocument, view = frame.contentWindow;
  if (view.MathJax && view.MathJax.Hub) await new Promise((done) => view.MathJax.Hub.Queue(done));
  const pictures = [...page.images], root = page.documentElement;
  const raw = (page.querySelector('.contents')?.innerText.match(/\\\\[()[\\]]/g) || []).length;
  return {page: url.split('/').pop(), scrolls: root.scrollWidth - root.clientWidth, cut: cut(page),
    unloaded: pictures.filter((p) => !p.complete || p.naturalWidth === 0).length, raw: raw,
    formulas: page.querySelectorAll('.MathJax_SVG svg').length,
    wrong: page.querySelectorAll('.MathJax_SVG_Error, [id^=MathJax-Element] .merror, .MathJax_SVG text').length};
}
onload = async () => {
  const report = [];
  for (const url of [\"${pages}\"]) report.push(await visit(url));
  document.getElementById('found').textContent = 'found ' + JSON.stringify(report) + ' end';
};
</script></body></html>
")
  execute_process(
    COMMAND "${CHROMIUM}" --headless --no-sandbox --disable-gpu --disable-quic --no-first-run
      --disable-background-networking --disable-component-update --disable-sync --disable-dev-shm-usage
      --user-data-dir=${SCRATCH}/profile --allow-file-access-from-files --enable-logging=stderr
      "--host-resolver-rules=MAP * ~NOTFOUND" --virtual-time-budget=600000 --window-size=1400,1000
      --dump-dom "file://${SCRATCH}/frame.html"
    RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE err TIMEOUT 1200)
  if(NOT out MATCHES "<pre id=\"found\">found (.*) end</pre>")
    message(FATAL_ERROR "no measurement: ${result}\n${err}")
  endif()
  set(report "${CMAKE_MATCH_1}" PARENT_SCOPE)
  string(REGEX MATCHALL "[^\n]*CONSOLE[^\n]*" said "${err}")
  set(said "${said}" PARENT_SCOPE)
endfunction()

# All pages that are written by hand, and some long and wide ones of the reference; with -D ALL=ON every page.
if(ALL)
  file(GLOB pages "${SITE}/*.html")
else()
  file(GLOB pages RELATIVE "${SITE}/../pages" "${SITE}/../pages/*.md")
  list(TRANSFORM pages REPLACE "(.*)\\.md" "${SITE}/\\1.html")
  list(TRANSFORM pages REPLACE "/main\\.html" "/index.html")
  foreach(page IN ITEMS annotated files classlacuna_1_1simulation structlacuna_1_1simulation__parameters
      structlacuna_1_1beam__bond law__concepts_8hpp)
    list(APPEND pages "${SITE}/${page}.html")
  endforeach()
endif()
foreach(page IN LISTS pages)
  if(NOT EXISTS "${page}")
    message(FATAL_ERROR "there is no page ${page}")
  endif()
endforeach()
list(TRANSFORM pages PREPEND "file://")
visit(${pages})

# faults_of(report): sets `faults`, the records of pages with faults, and `formulas`, the number of formulas drawn.
function(faults_of report)
  string(JSON count LENGTH "${report}")
  math(EXPR last "${count} - 1")
  set(formulas 0)
  set(faults "")
  foreach(k RANGE ${last})
    string(JSON record GET "${report}" ${k})
    string(JSON drawn GET "${record}" formulas)
    math(EXPR formulas "${formulas} + ${drawn}")
    foreach(what IN ITEMS scrolls cut unloaded raw wrong)
      string(JSON value GET "${record}" ${what})
      if(value GREATER 0)
        string(REGEX REPLACE "[ \n]+" " " record "${record}")
        string(APPEND faults "${record}\n")
        break()
      endif()
    endforeach()
  endforeach()
  set(faults "${faults}" PARENT_SCOPE)
  set(formulas ${formulas} PARENT_SCOPE)
endfunction()

faults_of("${report}")
list(LENGTH pages count)
message(STATUS "${count} pages, ${formulas} formulas drawn")
if(faults OR said)
  message(FATAL_ERROR "faults:\n${faults}${said}")
endif()

# The pages have as many formulas as were drawn.
file(GLOB sources "${SITE}/../pages/*.md")
set(wanted 0)
foreach(source IN LISTS sources)
  file(READ "${source}" text)
  string(REGEX MATCHALL "\\\\f[$] " marks "${text}")
  list(LENGTH marks found)
  math(EXPR wanted "${wanted} + ${found}")
endforeach()
math(EXPR wanted "${wanted} / 2")
if(formulas LESS wanted OR wanted LESS 50)
  message(FATAL_ERROR "${formulas} formulas drawn, the pages have ${wanted}")
endif()

file(READ "${SITE}/motion.html" page)
string(REPLACE "<head>" "<head><base href=\"file://${SITE}/\"/>" page "${page}")
string(REPLACE "<div class=\"textblock\">" "<div class=\"textblock\"><p style=\"width:800px\">wide</p>
  <p>\\(\\nosuchmacro\\)</p><pre>\\(raw\\)</pre><img src=\"missing.png\"><img src=\"https://example.invalid/x.png\">
  <script>console.error('script')</script>" page "${page}")
file(WRITE "${SCRATCH}/faulty.html" "${page}")
visit("file://${SCRATCH}/faulty.html")
foreach(fault IN ITEMS "scrolls\":[1-9]" "cut\":1" "unloaded\":2" "raw\":2" "wrong\":1")
  if(NOT report MATCHES "\"${fault}[,}0-9]" OR NOT said MATCHES script)
    message(FATAL_ERROR "a page with faults passes: no ${fault} in ${report}\n${said}")
  endif()
endforeach()
