# cmake -DCOMPILER=... -DCASE=file -DINCLUDE=dir -DSYSTEM=dirs -DPARSED=flags -P check.cmake

# The compilers' own defaults: what is counted is what a user sees.
set(flags -std=c++20 -fsyntax-only ${PARSED} "-I${INCLUDE}")
foreach(folder IN LISTS SYSTEM)
    list(APPEND flags -isystem "${folder}")
endforeach()

execute_process(COMMAND "${COMPILER}" ${flags} "${CASE}" RESULT_VARIABLE right ERROR_VARIABLE right_text)
if(NOT right EQUAL 0)
    message(FATAL_ERROR "does not compile without its mistake:\n${right_text}")
endif()

execute_process(COMMAND "${COMPILER}" ${flags} -DTAFONI_TEST_MISTAKE "${CASE}"
    RESULT_VARIABLE wrong ERROR_VARIABLE wrong_text)
if(wrong EQUAL 0)
    message(FATAL_ERROR "compiles in spite of its mistake")
endif()

string(REGEX MATCHALL "\n" newlines "${wrong_text}")
list(LENGTH newlines lines)
if(lines GREATER 20)
    message(FATAL_ERROR "the message has ${lines} lines, more than a reader takes in:\n${wrong_text}")
endif()

file(STRINGS "${CASE}" expectations REGEX "^// expect: ")
if(NOT expectations)
    message(FATAL_ERROR "the case says nothing of what to expect")
endif()
foreach(expectation IN LISTS expectations)
    string(REGEX REPLACE "^// expect: " "" expectation "${expectation}")
    if(NOT wrong_text MATCHES "${expectation}")
        message(FATAL_ERROR "the message lacks '${expectation}':\n${wrong_text}")
    endif()
endforeach()
