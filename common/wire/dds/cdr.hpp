#pragma once
// Private to common/wire, tests and the fuzzer: messages as the bytes that travel (CDR), without a network.
#include <dds/ddsi/ddsi_serdata.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/wire/dds/participant.hpp"
#include "common/wire/dds/typed.hpp"

namespace liloc::wire {

/// Encodes and decodes one type as DDS itself does. Not thread-safe; the participant must outlive it.
template <class T>
class Cdr {
 public:
  using Bytes = std::vector<unsigned char>;
  struct Free {
    void operator()(T* message) const { dds_sample_free(message, TypeOf<T>::descriptor(), DDS_FREE_ALL); }
  };

  /// `any`: a message that may be sent; DDS tells what it knows of a type only with one. Error: DDS's own.
  [[nodiscard]] static Result<Cdr> create(const Participant& seat, const T& any) {
    std::string topic = TypeOf<T>::descriptor()->m_typename;
    std::ranges::replace(topic, ':', '_');
    const auto writer = make_writer<T>(seat.handle(), seat.handle(), topic, kept_qos(1));
    if (!writer) return tl::unexpected(writer.error());
    auto reader = make_reader<T>(seat.handle(), seat.handle(), topic, kept_qos(1));
    if (!reader) return tl::unexpected(reader.error());
    if (auto sent = check(dds_write(writer->handle(), &any), "write"); !sent)
      return tl::unexpected(sent.error());
    ddsi_serdata* data = nullptr;
    dds_sample_info_t info;
    for (int i = 0; i < 500 && dds_takecdr(reader->handle(), &data, 1, &info, DDS_ANY_STATE) != 1; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (data == nullptr) return fail("{} did not come back within 5 s", TypeOf<T>::descriptor()->m_typename);
    return Cdr(std::move(*reader), data);
  }

  /// The four bytes of the encapsulation first. Empty: a message that DDS does not send.
  [[nodiscard]] Bytes encode(const T& message) const {
    const Serdata data(ddsi_serdata_from_sample(example_->type, SDK_DATA, &message), &ddsi_serdata_unref);
    if (!data) return {};
    Bytes bytes(ddsi_serdata_size(data.get()));
    ddsi_serdata_to_ser(data.get(), 0, bytes.size(), bytes.data());
    return bytes;
  }

  /// Null: what DDS refuses before a program sees it.
  [[nodiscard]] std::unique_ptr<T, Free> decode(const Bytes& bytes) const {
    if (bytes.size() < 4) return nullptr;  // DDS asserts an encapsulation
    const ddsrt_iovec_t part{const_cast<unsigned char*>(bytes.data()), bytes.size()};
    const Serdata data(ddsi_serdata_from_ser_iov(example_->type, SDK_DATA, 1, &part, bytes.size()),
                       &ddsi_serdata_unref);
    if (!data) return nullptr;
    std::unique_ptr<T, Free> message(static_cast<T*>(dds_alloc(sizeof(T))));  // zeroed
    if (!ddsi_serdata_to_sample(data.get(), message.get(), nullptr, nullptr)) return nullptr;
    return message;
  }

 private:
  using Serdata = std::unique_ptr<ddsi_serdata, decltype(&ddsi_serdata_unref)>;
  Cdr(Entity reader, ddsi_serdata* example)
      : reader_(std::move(reader)), example_(example, &ddsi_serdata_unref) {}
  Entity reader_;  // the type lives as long as it does
  Serdata example_;
};

}  // namespace liloc::wire
