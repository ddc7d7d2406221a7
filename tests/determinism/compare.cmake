# cmake -DPROGRAM=golden -DGOLDEN=golden.txt -P compare.cmake

execute_process(COMMAND "${PROGRAM}" OUTPUT_VARIABLE got RESULT_VARIABLE status)
file(READ "${GOLDEN}" want)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "the golden program ended with ${status}")
endif()
if(NOT got STREQUAL want)
    message(FATAL_ERROR "other bits than ${GOLDEN}; got:\n${got}\nexpected:\n${want}")
endif()
