# SPDX-License-Identifier: BSD-3-Clause
# Puts the pictures and examples of the pages in filters/ into ParaView's help pages, and makes index.html,
# which ParaView opens first, with a line for each of them.
#
#   cmake -D GENERATED=<folder> -D PAGES=<folder> -D PICTURES=<folder> -D OUTPUT=<folder> -P AddPages.cmake
#
# GENERATED has the pages <group>.<Proxy>.html that ParaView makes of the server-manager XML. Those for
# which there is PAGES/<Proxy>.md go to OUTPUT, with their pictures.
file(GLOB pages "${PAGES}/*.md")
set(lines)
foreach (page IN LISTS pages)
  get_filename_component(proxy "${page}" NAME_WE)
  file(GLOB generated "${GENERATED}/*.${proxy}.html")
  list(LENGTH generated count)
  if (NOT count EQUAL 1)
    message(FATAL_ERROR "${count} help pages for ${proxy}, instead of one, in ${GENERATED}")
  endif ()
  file(READ "${page}" text)
  if (NOT text MATCHES "!\\[([^]]*)\\]\\([^)]*/([A-Za-z]+\\.png)\\)")
    message(FATAL_ERROR "no picture in ${page}")
  endif ()
  set(caption "${CMAKE_MATCH_1}")
  set(picture "${CMAKE_MATCH_2}")
  if (NOT text MATCHES "```python\n(.*)```")
    message(FATAL_ERROR "no example in ${page}")
  endif ()
  set(example "${CMAKE_MATCH_1}")
  string(REPLACE "&" "&amp;" example "${example}")
  string(REPLACE "<" "&lt;" example "${example}")
  file(COPY "${PICTURES}/${picture}" DESTINATION "${OUTPUT}")

  file(READ "${generated}" html)
  get_filename_component(name "${generated}" NAME)
  if (NOT html MATCHES "<title> *([^<]*)</title>")
    message(FATAL_ERROR "no title in ${generated}")
  endif ()
  set(title "${CMAKE_MATCH_1}")
  # The first paragraph says in its first sentence what the filter is for.
  if (NOT html MATCHES "<i>[ \n]*<p>([^<]*)</p>")
    message(FATAL_ERROR "no short text in ${generated}")
  endif ()
  string(APPEND lines "<li><a href=\"${name}\">${title}</a>: ${CMAKE_MATCH_1}</li>\n")

  string(FIND "${html}" "<table" table)
  if (table EQUAL -1)
    message(FATAL_ERROR "no table of properties in ${generated}")
  endif ()
  string(SUBSTRING "${html}" 0 ${table} head)
  string(SUBSTRING "${html}" ${table} -1 rest)
  file(WRITE "${OUTPUT}/${name}" "${head}\
<p><img src=\"${picture}\"/></p><p><i>${caption}</i></p>\
<p>In Python:</p><pre>${example}</pre>${rest}")
endforeach ()
file(WRITE "${OUTPUT}/index.html" "<html><head><title>Conforming Delaunay</title></head><body>
<h2>Conforming Delaunay</h2>
<ul>
${lines}</ul>
</body></html>
")
