# The comment at the head of a file is about the file, and its words in the left column are headings.
s,^// ([A-Z][a-z]+) {2\,}([A-Z].*),/// @par \1\n/// \2,
s,^( *)// ?,\1/// ,
s|^(enum class .*\};) +// (.*)|/// \2\n\1|
s|([;,{}(]) +// |\1  ///< |
1s,.*,/// @file,
