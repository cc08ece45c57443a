// SPDX-License-Identifier: MIT
#include "runtime/baked/part.h"

namespace mien {

void PartWriter::put_array(const void* data, size_t count, uint32_t element_size) {
  at_ = align_up(at_, kBlockAlignment);
  const BakedArray entry = {at_, count, element_size, 0};
  memcpy(entry_, &entry, sizeof(entry));
  entry_ += sizeof(entry);
  if (count != 0) memcpy(part_ + at_, data, count * element_size);
  at_ += count * element_size;
}

PartReader::PartReader(const Baked& baked, const BakedPart& part, uint32_t version,
                       const PartMeasure& expected, Error& error)
    : part_(baked.data + part.offset), offset_(part.offset), size_(part.size), number_(part_),
      entry_(part_ + expected.number_count() * sizeof(uint64_t)), at_(expected.table_size()),
      error_(error) {
  const auto entry = static_cast<uint64_t>(reinterpret_cast<const uint8_t*>(&part) - baked.data);
  if (part.version != version) {
    status_ = fail(error_, Status::kBakedVersion, entry + offsetof(BakedPart, version),
                   "a part of the file is of version %u, this library reads %u; bake it again",
                   part.version, version);
  } else if (part.number_count != expected.number_count() ||
             part.array_count != expected.array_count() || size_ < expected.table_size()) {
    damaged(entry + offsetof(BakedPart, number_count), "table of parts");
  }
}

void PartReader::damaged(uint64_t offset, const char* what) {
  status_ = fail(error_, Status::kBakedStructure, offset,
                 "%s: the baked file is damaged; bake it again", what);
}

const uint8_t* PartReader::take_number() {
  if (status_ != Status::kOk) return nullptr;
  const uint8_t* number = number_;
  number_ += sizeof(uint64_t);
  return number;
}

void PartReader::number(bool& field) {
  const uint8_t* from = take_number();
  if (!from) return;
  if (*from > 1) return damaged(static_cast<uint64_t>(from - part_) + offset_, "numbers");
  field = *from != 0;
}

bool PartReader::next_has_elements_of(uint32_t size) const {
  if (status_ != Status::kOk) return false;
  BakedArray entry;
  memcpy(&entry, entry_, sizeof(entry));
  return entry.element_size == size;
}

const uint8_t* PartReader::take_array(uint32_t element_size, size_t& count) {
  if (status_ != Status::kOk) return nullptr;
  BakedArray entry;
  memcpy(&entry, entry_, sizeof(entry));
  const uint64_t offset = static_cast<uint64_t>(entry_ - part_) + offset_;
  entry_ += sizeof(entry);
  if (entry.element_size != element_size) {
    status_ = fail(error_, Status::kBakedVersion, offset,
                   "elements of %u bytes where this library has %u: the file was baked for another "
                   "kind of machine; bake it for this one",
                   entry.element_size, element_size);
    return nullptr;
  }
  at_ = align_up(at_, kBlockAlignment);
  if (entry.zero != 0 || entry.offset != at_ || at_ > size_ ||
      entry.count > (size_ - at_) / element_size) {
    damaged(offset, "table of arrays");
    return nullptr;
  }
  const uint8_t* data = part_ + at_;
  count = static_cast<size_t>(entry.count);
  at_ += count * element_size;
  return data;
}

Status PartReader::finish() {
  if (status_ == Status::kOk && align_up(at_, kBlockAlignment) != size_) {
    damaged(offset_ + at_, "end of a part");
  }
  return status_;
}

}  // namespace mien
