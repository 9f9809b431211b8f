# Joins HEAD, BODY and TAIL into TEXT and into a string constant of a name, TEXT.cpp.
file(READ ${HEAD} head)
file(READ ${BODY} body)
file(READ ${TAIL} tail)
# The head replaces what stands before the first function.
string(FIND "${body}" "/* ---- " begin)
if(begin LESS 0)
    message(FATAL_ERROR "${BODY}: where functions begin is not to be found")
endif()
string(SUBSTRING "${body}" ${begin} -1 body)
file(WRITE ${TEXT} "${head}${body}${tail}")
file(WRITE ${TEXT}.cpp "#include \"shader/texts.h\"\n\nconst char acdf::${NAME}[] = R\"acdf_text(${head}${body}${tail})acdf_text\";\n")
