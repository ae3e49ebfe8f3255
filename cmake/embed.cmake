# cmake -D TEXT=file -D NAME=namespace::variable -D OUT=file.cpp -P embed.cmake: a text file as a C string.
file(READ ${TEXT} text)
string(REGEX MATCH "^(.*)::([^:]+)$" matched ${NAME})
file(WRITE ${OUT} "namespace ${CMAKE_MATCH_1} {
extern const char* const ${CMAKE_MATCH_2};
const char* const ${CMAKE_MATCH_2} = R\"embedded(${text})embedded\";
}
")
