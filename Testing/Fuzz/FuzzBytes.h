// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Numbers out of a fuzzer's bytes; zeros when they run out.
#ifndef FuzzBytes_h
#define FuzzBytes_h

#include <cstddef>
#include <cstdint>
#include <cstring>

class FuzzBytes
{
public:
  FuzzBytes(const std::uint8_t* data, std::size_t size)
    : Data(data)
    , Left(size)
  {
  }

  template <typename T>
  T Take()
  {
    T value{};
    const std::size_t count = this->Left < sizeof(T) ? this->Left : sizeof(T);
    std::memcpy(&value, this->Data, count);
    this->Data += count;
    this->Left -= count;
    return value;
  }

  int TakeBelow(int bound) { return this->Take<std::uint8_t>() % bound; }
  bool TakeBool() { return this->TakeBelow(2) != 0; }

  /// Mostly a moderate number, now and then any bit pattern: NaN, infinity, denormal, huge.
  double TakeNumber()
  {
    const int kind = this->TakeBelow(8);
    if (kind == 0)
    {
      return this->Take<double>();
    }
    if (kind == 1)
    {
      return static_cast<double>(this->Take<float>());
    }
    return this->Take<std::int16_t>() / 256.0;
  }

private:
  const std::uint8_t* Data;
  std::size_t Left;
};

#endif
