# SPDX-License-Identifier: BSD-3-Clause
#
# cmake -D SOURCE=<repository> -D OUT=<folder> -D DOXYGEN=<program> -D MATHJAX=<folder> -D VERSION=<x.y.z> -P site.cmake: the
# documentation in OUT/html. A text that stands elsewhere is taken from there: the program and the limits from README.md, the
# pages of programs, of tests and of benches from their README.md. A warning of Doxygen is an error.

cmake_minimum_required(VERSION 3.25)

if(NOT EXISTS "${DOXYGEN}" OR NOT EXISTS "${MATHJAX}/MathJax.js")
  message(FATAL_ERROR "the documentation needs Doxygen ('${DOXYGEN}') and MathJax 2 ('${MATHJAX}'): "
    "sh cmake/dependencies.sh documentation, or give -D LACUNA_DOXYGEN=<program> -D LACUNA_MATHJAX=<folder of MathJax.js>")
endif()

file(REMOVE_RECURSE "${OUT}")
file(MAKE_DIRECTORY "${OUT}/pages")
file(GLOB pages "${CMAKE_CURRENT_LIST_DIR}/*.md")
file(COPY ${pages} DESTINATION "${OUT}/pages")

# section(out heading file): the text below a heading of a file, up to the next of its kind.
function(section out heading file)
  file(READ "${SOURCE}/${file}" text)
  string(FIND "${text}" "\n## ${heading}\n" from)
  if(from EQUAL -1)
    message(FATAL_ERROR "${file} has no section '${heading}'")
  endif()
  string(SUBSTRING "${text}" ${from} -1 text)
  string(REPLACE "\n## ${heading}\n" "" text "${text}")
  string(FIND "${text}" "\n## " to)
  string(SUBSTRING "${text}" 0 ${to} text)
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# site_links(out text): links to a document or a tutorial program become links to its page. Other files of the repository are
# not on the site: of a link to them the text stays. Pictures and addresses stay.
string(ASCII 1 kept)
function(site_links out text)
  string(REGEX REPLACE "!\\[([^]\n]*)\\]\\(" "!${kept}\\1${kept}(" text "${text}")
  string(REGEX REPLACE "\\[([^]\n]*)\\]\\((https?://)" "${kept}\\1${kept}(\\2" text "${text}")
  set(documents "scenario;lacuna_run;cartilage;cartilage;uniaxial;uniaxial;poroelasticity;poroelasticity"
    "tutorial;tutorial;tests;validation;bench;benches")
  while(documents)
    list(POP_FRONT documents folder label)
    string(REGEX REPLACE "\\[([^]\n]*)\\]\\([^)\n]*${folder}/README.md[^)\n]*\\)" "\\\\ref ${label} \"\\1\"" text "${text}")
  endwhile()
  string(REGEX REPLACE "\\[([^]\n]*)\\]\\(([0-9][0-9]_[a-z_]+)\\.cpp\\)" "\\\\subpage tutorial_\\2 \"\\1\"" text "${text}")
  string(REGEX REPLACE "\\[([^]\n]*)\\]\\([^)\n]*\\)" "\\1" text "${text}")
  string(REGEX REPLACE "${kept}([^${kept}\n]*)${kept}" "[\\1]" text "${text}")
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# readme_page(label title text): a document as a page; its own title goes.
function(readme_page label title text)
  string(REGEX REPLACE "^# [^\n]*\n" "" text "${text}")
  site_links(text "${text}")
  file(WRITE "${OUT}/pages/${label}.md" "# ${title} {#${label}}\n${text}")
endfunction()

section(program "A program of one's own" README.md)
if(NOT program MATCHES "(```cpp\n[^`]*```)\n\nIt prints `([^`]*)`")
  message(FATAL_ERROR "README.md has no program, or does not say what it prints")
endif()
set(PROGRAM "${CMAKE_MATCH_1}")
set(PRINTS "${CMAKE_MATCH_2}")
configure_file("${CMAKE_CURRENT_LIST_DIR}/main.md.in" "${OUT}/pages/main.md" @ONLY)

section(limits "Not there yet, not validated" README.md)
readme_page(limits "Limits" "${limits}")

foreach(name IN ITEMS cartilage uniaxial poroelasticity)
  file(READ "${SOURCE}/examples/${name}/README.md" text)
  readme_page(${name} ${name} "${text}")
endforeach()

# The keys of a deck, which a test compares with the program's own table, have a page of their own.
file(READ "${SOURCE}/examples/scenario/README.md" text)
section(keys "Keys" examples/scenario/README.md)
readme_page(deck_keys "Deck keys of lacuna-run" "${keys}")
string(REPLACE "${keys}" "\nSee \\ref deck_keys.\n" text "${text}")
readme_page(lacuna_run "lacuna-run: a run without writing C++" "${text}")

# A page for each tutorial program: what it shows stands in a row of the table, the program below it.
file(READ "${SOURCE}/examples/tutorial/README.md" text)
readme_page(tutorial "Tutorial" "${text}")
file(GLOB programs RELATIVE "${SOURCE}/examples/tutorial" "${SOURCE}/examples/tutorial/[0-9]*.cpp")
set(tutorials "")
foreach(program IN LISTS programs)
  string(REPLACE ".cpp" "" name "${program}")
  if(NOT text MATCHES "\n\\| \\[${name}\\]\\(${program}\\) \\| ([^|\n]*) \\| ([^|\n]*) \\|")
    message(FATAL_ERROR "examples/tutorial/README.md has no row for ${program}")
  endif()
  file(WRITE "${OUT}/pages/tutorial_${name}.md" "# ${name} {#tutorial_${name}}\n
**Idea:** ${CMAKE_MATCH_1}.\n\n**Number that it checks:** ${CMAKE_MATCH_2}.\n\n`examples/tutorial/${program}`:\n
\\include{lineno} ${program}\n")
  list(APPEND tutorials tutorial_${name})
endforeach()

file(READ "${SOURCE}/tests/README.md" text)
readme_page(validation "Tests and validation" "${text}")
file(READ "${SOURCE}/bench/README.md" text)
readme_page(benches "Speed and benches" "${text}")

# Doxygen passes over a name that it does not know: a page must not name what has gone.
file(GLOB_RECURSE headers "${SOURCE}/include/lacuna/*.hpp")
set(code "")
foreach(header IN LISTS headers ITEMS "${SOURCE}/cmake/lacuna_components.cmake" "${SOURCE}/CMakeLists.txt")
  file(READ "${header}" text)
  string(APPEND code "${text}")
endforeach()
file(GLOB pages "${CMAKE_CURRENT_LIST_DIR}/*.md" "${CMAKE_CURRENT_LIST_DIR}/*.in")
foreach(page IN LISTS pages)
  file(READ "${page}" text)
  string(REGEX MATCHALL "[a-z_]+(::[a-z_0-9]+)+" names "${text}")
  foreach(name IN LISTS names)
    string(REPLACE "::" ";" words "${name}")
    foreach(word IN LISTS words)
      if(NOT code MATCHES "[^a-z_0-9]${word}[^a-z_0-9]")
        message(FATAL_ERROR "${page}: there is no '${word}' (${name}) in include/lacuna")
      endif()
    endforeach()
  endforeach()
  string(REGEX MATCHALL "[^:a-z_][a-z_]+\\(\\)" names "${text}")
  foreach(name IN LISTS names)
    string(REGEX REPLACE "[^a-z_]" "" name "${name}")
    if(NOT code MATCHES "[^a-z_0-9]${name}\\(" AND NOT text MATCHES "auto [a-z]+ = ${name}\\(")
      message(FATAL_ERROR "${page}: there is no function ${name}() in include/lacuna")
    endif()
  endforeach()
  string(REGEX MATCHALL "[`</][a-z_]+(/[a-z_]+)+\\.hpp" files "${text}")
  foreach(name IN LISTS files)
    string(REGEX REPLACE "^[`</]|^.*include/lacuna/" "" name "${name}")
    string(REGEX REPLACE "^lacuna/" "" name "${name}")
    if(NOT EXISTS "${SOURCE}/include/lacuna/${name}")
      message(FATAL_ERROR "${page}: there is no header ${name}")
    endif()
  endforeach()
endforeach()

configure_file("${CMAKE_CURRENT_LIST_DIR}/Doxyfile.in" "${OUT}/Doxyfile" @ONLY)
execute_process(COMMAND "${DOXYGEN}" "${OUT}/Doxyfile" RESULT_VARIABLE result OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${said}")
endif()
# As much of MathJax as draws TeX as SVG.
foreach(part IN ITEMS MathJax.js extensions jax/element jax/input/TeX jax/output/SVG/autoload jax/output/SVG/config.js
    jax/output/SVG/jax.js jax/output/SVG/fonts/TeX)
  if(NOT EXISTS "${MATHJAX}/${part}")
    message(FATAL_ERROR "${MATHJAX} has no ${part}: is it MathJax 2?")
  endif()
  get_filename_component(folder "${part}" DIRECTORY)
  file(COPY "${MATHJAX}/${part}" DESTINATION "${OUT}/html/mathjax/${folder}")
endforeach()

foreach(page IN ITEMS index install units restart paraview lacuna_run deck_keys cartilage uniaxial poroelasticity tutorial ${tutorials}
    motion contacts bonds flow time_step how_a_step_works decisions other_codes validation benches limits)
  if(NOT EXISTS "${OUT}/html/${page}.html")
    message(FATAL_ERROR "there is no page ${page}.html")
  endif()
endforeach()

# The box for searching finds what begins with the word that is typed.
file(GLOB entries "${OUT}/html/search/all_*.js")
set(found "")
foreach(entry IN LISTS entries)
  file(READ "${entry}" text)
  string(APPEND found "${text}")
endforeach()
foreach(word IN ITEMS restart units paraview install tutorial deck_20keys cartilage checkpoint_5fevery bonds tests speed)
  if(NOT found MATCHES "\n  \\['${word}")
    message(FATAL_ERROR "a search for '${word}' finds nothing")
  endif()
endforeach()
message(STATUS "documentation: ${OUT}/html/index.html")
