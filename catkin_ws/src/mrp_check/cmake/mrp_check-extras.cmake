# SPDX-License-Identifier: BSD-3-Clause
# Checks the package that calls it, as one of its tests: `catkin_make run_tests`.
#
#   mrp_check_add_test()           what is wrong by itself
#   mrp_check_add_test(SPEC file)  by a contract, such as pub_sub or one of the package's own files
function(mrp_check_add_test)
  cmake_parse_arguments(_check "" "SPEC" "" ${ARGN})
  if(_check_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "mrp_check_add_test() takes SPEC alone; found: ${_check_UNPARSED_ARGUMENTS}")
  endif()

  set(contract "--any")
  if(_check_SPEC)
    set(contract "--spec '${_check_SPEC}'")
  endif()

  # Where catkin_test_results looks.
  get_filename_component(folder "${CATKIN_TEST_RESULTS_DIR}/${PROJECT_NAME}" ABSOLUTE)
  catkin_run_tests_target("mrp_check" "package" "mrp_check.xml"
    WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}"
    COMMAND
      "'${CMAKE_COMMAND}' -E make_directory '${folder}'"
      "rosrun mrp_check check '${PROJECT_SOURCE_DIR}' ${contract} --junit '${folder}/mrp_check.xml'"
  )
endfunction()
