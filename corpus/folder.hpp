// SPDX-License-Identifier: Apache-2.0
//
// Where the corpus is, in the tree that the program was built in and on other machines.
#ifndef SUREFILL_CORPUS_FOLDER_HPP
#define SUREFILL_CORPUS_FOLDER_HPP

#include <string>

namespace surefill::corpus {

// The folder of cases/ and meshes/: `built_from` if it is there, else one that lies beside the program, or where an
// installation puts it. Empty if there is none.
std::string corpus_folder(const std::string& built_from);

}  // namespace surefill::corpus

#endif  // SUREFILL_CORPUS_FOLDER_HPP
