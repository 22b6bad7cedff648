// io/motion_file.h - reads a motion from JSON; docs/motion.md describes the format.
//
// Thread safety: functions without state.
#pragma once

#include <strahl/io/file_bytes.h>
#include <strahl/io/motion.h>

namespace strahl {

/// Reads a motion of the rig's nodes. Throws Error{bad_input} citing the JSON pointer: malformed
/// JSON, unknown members, nodes that do not exist or share their name, times that do not ascend,
/// numbers of values that differ from that of times, values that are not finite, a rotation or axis
/// of no length.
Motion read_motion(const FileBytes& file, const Rig& rig);

}  // namespace strahl
