// SPDX-License-Identifier: Apache-2.0
//
// `surefill corpus add`: a finding becomes a case of the corpus.
#ifndef SUREFILL_CERTIFY_CORPUS_ADD_HPP
#define SUREFILL_CERTIFY_CORPUS_ADD_HPP

#include <string>

namespace surefill::certify {

struct CorpusAddOptions {
  std::string finding;          // a scene file
  std::string origin;           // one line: where it was found
  std::string corpus;           // the folder of cases/
  std::string group = "found";  // the folder within cases/
  std::string name;             // of the case; empty: the finding's file name
};

// Writes CORPUS/cases/GROUP/NAME.scene, with the origin in its comment, and returns that path. Throws
// std::runtime_error, and writes nothing, if the corpus has the scene already (whatever its comment says), if the name
// is taken or cannot be one, or if the engine refuses the scene.
std::string add_to_corpus(const CorpusAddOptions& options);

}  // namespace surefill::certify

#endif  // SUREFILL_CERTIFY_CORPUS_ADD_HPP
