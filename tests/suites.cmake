# Read by ctest whenever it starts: each suite of PROGRAM is one test, so that a start is paid once and what its tests
# share is made once. Where a program crashes, the last "[ RUN ]" of its output names the test. Of the suites in APART,
# whose tests take long and share nothing, each test is one for ctest; these begin first.
# PROGRAM, PROCESSORS, COST and APART come from the file that includes this one (tests/CMakeLists.txt).
cmake_minimum_required(VERSION 3.25)
if(NOT EXISTS "${PROGRAM}")
    get_filename_component(name "${PROGRAM}" NAME)
    add_test("${name}_NOT_BUILT" "${PROGRAM}")
    return()
endif()
execute_process(COMMAND "${PROGRAM}" --gtest_list_tests OUTPUT_VARIABLE listed RESULT_VARIABLE status)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "${PROGRAM} cannot list its tests: ${status}")
endif()
string(REGEX REPLACE "[ ]*#[^\n]*" "" listed "${listed}") # what a parameter is
string(REPLACE "\n" ";" listed "${listed}")
foreach(line IN LISTS listed)
    if(line MATCHES "^([A-Za-z0-9_/]+)\\.$")
        set(suite "${CMAKE_MATCH_1}")
        get_filename_component(plain "${suite}" NAME) # without the prefix of its parameters
        if("${plain}" IN_LIST APART)
            continue()
        endif()
        add_test("${suite}" "${PROGRAM}" "--gtest_filter=${suite}.*")
        set_tests_properties("${suite}" PROPERTIES TIMEOUT 900 PROCESSORS ${PROCESSORS} COST ${COST})
        if(suite STREQUAL GenicamCamera) # one GigE Vision camera has the loopback's port at a time; ui.table has one, too
            set_tests_properties("${suite}" PROPERTIES RESOURCE_LOCK gige)
        endif()
    elseif(line MATCHES "^  ([A-Za-z0-9_/]+)$" AND "${plain}" IN_LIST APART)
        set(test "${suite}.${CMAKE_MATCH_1}")
        add_test("${test}" "${PROGRAM}" "--gtest_filter=${test}")
        set_tests_properties("${test}" PROPERTIES TIMEOUT 600 PROCESSORS ${PROCESSORS} COST 500)
    endif()
endforeach()
