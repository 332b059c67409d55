#pragma once
#include <dds/dds.h>

#include "interfaces/recording/type_description.hpp"

namespace node {

/// What a DDS type looks like, from the type information that its descriptor carries: idlc's
/// (without -t) and those of dds_create_topic_descriptor alike, so that types found on the bus
/// need not be known when this is compiled.
/// Enums and bitmasks become unsigned integers of their width, typedefs what they stand for,
/// `char` and `int8` (a byte in XTypes 1.2) uint8, arrays of several dimensions one long array:
/// the bytes on the wire are the same. @unit is kept.
/// Throws std::invalid_argument (type, member, why) for what a ROS 2 message cannot say: unions,
/// maps, wide characters, optional or external members, sequences in sequences, and types that
/// are not @final.
recording::TypeDescription describe(const dds_topic_descriptor_t& type);

}  // namespace node
