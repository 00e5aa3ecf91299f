// SPDX-License-Identifier: MIT
#pragma once

namespace fragtrace {

/// Returns true if standard output was closed before the program began. A line about a file that was written
/// is of no use there; a result is an error (checkPrinted).
bool standardOutputIsClosed();

/// Throws RenderError where standard output could not take all that was printed; ends the process with
/// status 1, without a word, where that is a pipe whose reader has left.
void checkPrinted();

/// Ends the process, once all is written, with this status. The system takes back at once what the driver and
/// its compiler would give back piece by piece, which takes 20 ms. Sanitizers look for leaks when the caller
/// returns, so there it comes back with the status.
int leave(int status);

}  // namespace fragtrace
