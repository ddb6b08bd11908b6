# SPDX-License-Identifier: BSD-3-Clause
#
# cmake -D WRITER=... -D CHROMIUM=... -D SCRATCH=... [-D REPORT=page.html] -P browser.cmake
# Opens the report in headless Chromium at 1280 and 390 pixels and measures it. Then does the same with a page that has
# each fault that the script looks for, and checks that it finds them.

cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE "${SCRATCH}")
file(MAKE_DIRECTORY "${SCRATCH}/report")
if(DEFINED REPORT)
  file(COPY_FILE "${REPORT}" "${SCRATCH}/report/report.html")
else()
  execute_process(COMMAND "${WRITER}" "${SCRATCH}/report" RESULT_VARIABLE result ERROR_VARIABLE err)
  if(NOT result STREQUAL "0")
    message(FATAL_ERROR "no report: ${result}\n${err}")
  endif()
endif()

# measure(page width): sets width, tables, pictures, unloaded, nameless, cut, scrolls, and console: the messages of the
# browser's console. The page is shown in a frame, because windows are at least 500 pixels wide.
function(measure page width)
  file(WRITE "${SCRATCH}/frame.html" "<!DOCTYPE html><html><body style=\"margin:0\">
<iframe id=\"frame\" src=\"${page}\" style=\"width:${width}px;height:900px;border:0\"></iframe><pre id=\"found\"></pre>
<script>
onload = () => {
  const page = document.getElementById('frame').contentDocument, root = page.documentElement;
  const pictures = [...page.images];
  // Elements that extend beyond the page are cut off, because the page does not scroll.
  const cut = [...page.querySelectorAll('h1, h2, p, img, figcaption')].filter(
    (e) => e.getBoundingClientRect().right > root.clientWidth + 0.5);
  document.getElementById('found').textContent = 'found ' + JSON.stringify({
    width: page.defaultView.innerWidth, tables: page.querySelectorAll('table').length, pictures: pictures.length,
    unloaded: pictures.filter((p) => !p.complete || p.naturalWidth === 0).length,
    nameless: pictures.filter((p) => !p.alt).length, cut: cut.length,
    scrolls: root.scrollWidth - root.clientWidth}) + ' end';
};
</script></body></html>
")
  # A new profile each time, so that no user setting and no earlier page matters.
  file(REMOVE_RECURSE "${SCRATCH}/profile")
  execute_process(
    COMMAND "${CHROMIUM}" --headless --no-sandbox --disable-gpu --disable-quic --no-first-run
      --disable-background-networking --disable-component-update --disable-sync --disable-dev-shm-usage
      --user-data-dir=${SCRATCH}/profile --allow-file-access-from-files --enable-logging=stderr
      --virtual-time-budget=10000 --window-size=1400,1000 --dump-dom "file://${SCRATCH}/frame.html"
    RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE err TIMEOUT 120)
  if(NOT out MATCHES "<pre id=\"found\">found ({[^}]*}) end</pre>")
    message(FATAL_ERROR "no measurement of ${page} at ${width}: ${result}\n${err}")
  endif()
  set(found "${CMAKE_MATCH_1}")
  message(STATUS "${page} at ${width}: ${found}")
  foreach(what IN ITEMS width tables pictures unloaded nameless cut scrolls)
    string(JSON value GET "${found}" ${what})
    set(${what} "${value}" PARENT_SCOPE)
  endforeach()
  string(REGEX MATCHALL "[^\n]*CONSOLE[^\n]*" console "${err}")
  set(console "${console}" PARENT_SCOPE)
endfunction()

function(expect)
  cmake_language(EVAL CODE "if(${ARGV0})\nset(holds TRUE)\nelse()\nset(holds FALSE)\nendif()")
  if(NOT holds)
    message(FATAL_ERROR "does not hold: ${ARGV0}")
  endif()
endfunction()

foreach(wanted IN ITEMS 1280 390)
  measure(report/report.html ${wanted})
  expect("width EQUAL ${wanted} AND scrolls LESS_EQUAL 0 AND cut EQUAL 0")
  expect("tables GREATER_EQUAL 3 AND pictures GREATER_EQUAL 7 AND unloaded EQUAL 0 AND nameless EQUAL 0")
  if(NOT console STREQUAL "")
    message(FATAL_ERROR "the console has ${console}")
  endif()
endforeach()

file(READ "${SCRATCH}/report/report.html" page)
string(REPLACE "</body>" "<p style=\"width:1500px\">wide</p><img src=\"data:image/png;base64,AAAA\"><img
  src=\"https://example.invalid/x.png\" alt=\"elsewhere\"><script>console.error('script')</script></body>" page "${page}")
file(WRITE "${SCRATCH}/faulty.html" "${page}")
measure(faulty.html 390)
expect("scrolls GREATER 0 AND cut EQUAL 1 AND unloaded EQUAL 2 AND nameless EQUAL 1")
expect("console MATCHES example.invalid AND console MATCHES script")
