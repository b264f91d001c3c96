# Write an add_test() for every case that PROGRAM (Boost.Test) lists, into the file LIST.

execute_process(COMMAND ${PROGRAM} --list_content=HRF ERROR_VARIABLE _content COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" _lines "${_content}")

set(_tests "")
set(_suites "") # of the line at hand, outermost first
set(_count 0)
list(LENGTH _lines _end)
foreach(_line IN LISTS _lines)
  math(EXPR _count "${_count} + 1")
  if(NOT _line MATCHES "^( *)([^ *]+)\\*?")
    continue()
  endif()
  set(_name ${CMAKE_MATCH_2})
  string(LENGTH "${CMAKE_MATCH_1}" _indent)
  math(EXPR _depth "${_indent} / 4")
  list(SUBLIST _suites 0 ${_depth} _suites)

  set(_next "")
  if(_count LESS _end)
    list(GET _lines ${_count} _next)
  endif()
  string(REGEX REPLACE "[^ ].*" "" _next "${_next}")
  string(LENGTH "${_next}" _next_indent)
  list(APPEND _suites ${_name})
  if(NOT _next_indent GREATER _indent) # nothing below it: a case, not a suite
    list(JOIN _suites "/" _path)
    string(APPEND _tests "add_test([==[${_path}]==] [==[${PROGRAM}]==] [==[--run_test=${_path}]==] --color_output=no)\n")
  endif()
endforeach()
file(WRITE ${LIST} "${_tests}")
