#pragma once
#include <dds/dds.h>

#include "interfaces/recording/type_description.hpp"

namespace node {

/// Describes a DDS type from the type information in its descriptor. Works for descriptors of idlc
/// (without -t) and of dds_create_topic_descriptor, so types found on the bus need not be known at
/// compile time.
/// Enums and bitmasks become unsigned integers of their width; typedefs become their underlying
/// type; `char` and `int8` (a byte in XTypes 1.2) become uint8; arrays of several dimensions become
/// one long array. The bytes on the wire are the same. `@unit` is kept.
/// Throws std::invalid_argument (type, member, reason) for types that a ROS 2 message cannot
/// represent: unions, maps, wide characters, optional or external members, sequences in sequences,
/// and types that are not `@final`.
recording::TypeDescription describe(const dds_topic_descriptor_t& type);

}  // namespace node
