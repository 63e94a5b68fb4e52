# Run as a script: FILE becomes BASE.hpp and BASE.cpp, which hold it as mpm::io::embedded::NAME.
file(READ ${FILE} text)
file(WRITE ${BASE}.hpp "#pragma once\n#include <string_view>\n
namespace mpm::io::embedded {\nextern const std::string_view ${NAME};\n}\n")
# All supported compilers accept literals longer than the standard's minimum; clang only warns.
file(WRITE ${BASE}.cpp "#pragma GCC diagnostic ignored \"-Woverlength-strings\"
#include \"io/embedded/${NAME}.hpp\"\n
namespace mpm::io::embedded {\nconstinit const std::string_view ${NAME} = R\"embedded(${text})embedded\";\n}\n")
