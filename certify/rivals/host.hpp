// SPDX-License-Identifier: Apache-2.0
//
// The process in which a plugin lives: it loads the shared library and answers messages with it.
#ifndef SUREFILL_CERTIFY_ADAPTERS_HOST_HPP
#define SUREFILL_CERTIFY_ADAPTERS_HOST_HPP

#include <string>

namespace surefill::adapters {

// Serves stdin until it closes; returns the exit status. Output buffers end at a page that cannot be touched and begin
// after a margin that is looked at, and the scene cannot be written to, so a stray write is named, or ends the process.
int host_plugin(const std::string& library, const std::string& arguments);

}  // namespace surefill::adapters

#endif  // SUREFILL_CERTIFY_ADAPTERS_HOST_HPP
