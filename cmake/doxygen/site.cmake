# SPDX-License-Identifier: BSD-3-Clause
#
# cmake -D SOURCE=<repository> -D OUT=<folder> -D DOXYGEN=<program> -D MATHJAX=<folder> -D VERSION=<x.y.z> -P
# site.cmake: writes the documentation to OUT/html. The example program and the limits come from README.md, the pages
# of programs, tests and benches from their README.md. A warning of Doxygen is an error.

cmake_minimum_required(VERSION 3.25)

if(NOT EXISTS "${DOXYGEN}" OR NOT EXISTS "${MATHJAX}/MathJax.js")
  message(FATAL_ERROR "the documentation needs Doxygen ('${DOXYGEN}') and MathJax 2 ('${MATHJAX}'): run sh "
    "cmake/dependencies.sh documentation, or give -D LACUNA_DOXYGEN=<program> -D LACUNA_MATHJAX=<folder of MathJax.js>")
endif()

file(REMOVE_RECURSE "${OUT}")
file(MAKE_DIRECTORY "${OUT}/pages")
file(GLOB pages "${CMAKE_CURRENT_LIST_DIR}/*.md")
file(COPY ${pages} DESTINATION "${OUT}/pages")

# section(out heading file): the text below a heading of a file, up to the next heading of that level.
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

# site_links(out text): links to a document or a tutorial program become links to its page. Links to other files of the
# repository, which are not on the site, are replaced by their text. Pictures and web addresses are left alone.
string(ASCII 1 mark)
function(site_links out text)
  string(REGEX REPLACE "!\\[([^]\n]*)\\]\\(" "!${mark}\\1${mark}(" text "${text}")
  string(REGEX REPLACE "\\[([^]\n]*)\\]\\((https?://)" "${mark}\\1${mark}(\\2" text "${text}")
  set(documents "scenario;lacuna_run;cartilage;cartilage;uniaxial;uniaxial;poroelasticity;poroelasticity"
    "tutorial;tutorial;tests;validation;bench;benches")
  while(documents)
    list(POP_FRONT documents folder label)
    string(REGEX REPLACE "\\[([^]\n]*)\\]\\([^)\n]*${folder}/README.md[^)\n]*\\)" "\\\\ref ${label} \"\\1\""
      text "${text}")
  endwhile()
  string(REGEX REPLACE "\\[([^]\n]*)\\]\\(([0-9][0-9]_[a-z_]+)\\.cpp\\)" "\\\\subpage tutorial_\\2 \"\\1\""
    text "${text}")
  string(REGEX REPLACE "\\[([^]\n]*)\\]\\([^)\n]*\\)" "\\1" text "${text}")
  string(REGEX REPLACE "${mark}([^${mark}\n]*)${mark}" "[\\1]" text "${text}")
  set(${out} "${text}" PARENT_SCOPE)
endfunction()

# readme_page(label title text): writes a document as a page under a title that replaces its own.
function(readme_page label title text)
  string(REGEX REPLACE "^# [^\n]*\n" "" text "${text}")
  site_links(text "${text}")
  file(WRITE "${OUT}/pages/${label}.md" "# ${title} {#${label}}\n${text}")
endfunction()

section(program "Your own program" README.md)
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

# The keys of a deck get a separate page. A test compares them with the program's own table.
file(READ "${SOURCE}/examples/scenario/README.md" text)
section(keys "Keys" examples/scenario/README.md)
readme_page(deck_keys "Deck keys of lacuna-run" "${keys}")
string(REPLACE "${keys}" "\nSee \\ref deck_keys.\n" text "${text}")
readme_page(lacuna_run "lacuna-run: a run without writing C++" "${text}")

# A page for each tutorial program: its row in the table of README.md, then its source.
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

# Each folder of tests has one row, and each row names a folder or a file that exists.
file(READ "${SOURCE}/tests/README.md" text)
string(REGEX MATCHALL "\n\\| `[^|]*` \\|" rows "${text}")
string(REGEX MATCHALL "`[a-z_./]+`" names "${rows}")
set(folders_listed "")
foreach(name IN LISTS names)
  string(REPLACE "`" "" name "${name}")
  file(GLOB found "${SOURCE}/tests/${name}" "${SOURCE}/tests/*/${name}")
  if(NOT found)
    message(FATAL_ERROR "tests/README.md: there is no ${name}")
  elseif(name MATCHES "\\.cpp$")
    continue()
  elseif(name IN_LIST folders_listed)
    message(FATAL_ERROR "tests/README.md has two rows for ${name}")
  endif()
  list(APPEND folders_listed "${name}")
endforeach()
file(GLOB folders RELATIVE "${SOURCE}/tests" "${SOURCE}/tests/*/CMakeLists.txt" "${SOURCE}/tests/*/*.cpp")
list(TRANSFORM folders REPLACE "/.*" "")
list(REMOVE_DUPLICATES folders)
foreach(folder IN LISTS folders)
  if(NOT folder IN_LIST folders_listed)
    message(FATAL_ERROR "tests/README.md has no row for the folder ${folder}")
  endif()
endforeach()
readme_page(validation "Tests and validation" "${text}")
file(READ "${SOURCE}/bench/README.md" text)
readme_page(benches "Speed and benches" "${text}")

# Doxygen ignores names that it does not know. A page must not name classes, functions or headers that do not exist.
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
# The parts of MathJax that draw TeX as SVG.
foreach(part IN ITEMS MathJax.js extensions jax/element jax/input/TeX jax/output/SVG/autoload jax/output/SVG/config.js
    jax/output/SVG/jax.js jax/output/SVG/fonts/TeX)
  if(NOT EXISTS "${MATHJAX}/${part}")
    message(FATAL_ERROR "${MATHJAX} has no ${part}: is it MathJax 2?")
  endif()
  get_filename_component(folder "${part}" DIRECTORY)
  file(COPY "${MATHJAX}/${part}" DESTINATION "${OUT}/html/mathjax/${folder}")
endforeach()

foreach(page IN ITEMS index install units restart paraview lacuna_run deck_keys cartilage uniaxial poroelasticity
    tutorial ${tutorials} motion contacts bonds flow time_step equilibrium how_a_step_works decisions other_codes validation benches
    limits)
  if(NOT EXISTS "${OUT}/html/${page}.html")
    message(FATAL_ERROR "there is no page ${page}.html")
  endif()
endforeach()

# The search box finds entries that begin with the typed word.
file(GLOB entries "${OUT}/html/search/all_*.js")
set(found "")
foreach(entry IN LISTS entries)
  file(READ "${entry}" text)
  string(APPEND found "${text}")
endforeach()
foreach(word IN ITEMS restart units paraview install tutorial deck_20keys cartilage
    checkpoint_5fevery bonds tests speed equilibrium)
  if(NOT found MATCHES "\n  \\['${word}")
    message(FATAL_ERROR "a search for '${word}' finds nothing")
  endif()
endforeach()
message(STATUS "documentation: ${OUT}/html/index.html")
