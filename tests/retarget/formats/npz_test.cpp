// NumPy arrays: numbers of every type, without loss where they are whole.
#include "retarget/formats/npz.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "retarget/base/error.hpp"

namespace understudy {
namespace {

template <class T>
std::string array_bytes(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

NpyArray parsed(const std::string& descr, const std::string& shape, const std::string& body,
                const std::string& fortran = "False") {
  std::string header =
      "{'descr': '" + descr + "', 'fortran_order': " + fortran + ", 'shape': " + shape + ", }";
  header.resize(117, ' ');
  return parse_npy("\x93NUMPY" + std::string("\1\0\x76\0", 4) + header + "\n" + body, "x.npy");
}

TEST(Npz, IntegersAbove2To24AreReadWithoutLoss) {
  const std::vector<int32_t> faces = {16777216, 16777217, 16777219};
  const IntegerMatrix read = parsed("<i4", "(1, 3)", array_bytes(faces)).integers(3, "x");
  EXPECT_EQ(read(0, 0), 16777216);
  EXPECT_EQ(read(0, 1), 16777217);
  EXPECT_EQ(read(0, 2), 16777219);
}

TEST(Npz, IntegersOfEightBytesAreReadWithoutLoss) {
  const int64_t most = 9000000000000000;
  const IntegerMatrix read =
      parsed("<i8", "(3,)", array_bytes(std::vector<int64_t>{most - 1, -5, int64_t{1} << 62}))
          .integers(1, "x");
  EXPECT_EQ(read(0, 0), most - 1);
  EXPECT_EQ(read(1, 0), -5);
  EXPECT_EQ(read(2, 0), -1);
}

TEST(Npz, IntegersInFortranOrderStandWhereTheFloatsStand) {
  const NpyArray array =
      parsed("<u4", "(2, 3)", array_bytes(std::vector<uint32_t>{0, 3, 1, 4, 2, 5}), "True");
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(array.values[i], static_cast<float>(i));
    EXPECT_EQ(array.whole[i], i);
  }
}

TEST(Npz, AListOfNamesIsReadWhole) {
  const std::string fist{"f\0\0\0i\0\0\0s\0\0\0t\0\0\0", 16}, ok{"o\0\0\0k\0\0\0\0\0\0\0\0\0\0\0", 16};
  const NpyArray names = parsed("<U4", "(2,)", fist + ok);
  ASSERT_EQ(names.texts.size(), 2u);
  EXPECT_EQ(names.texts[0], "fist");
  EXPECT_EQ(names.texts[1], "ok");
  EXPECT_EQ(names.text, "fist");
  EXPECT_EQ(parsed("<U4", "(2,)", fist).texts.size(), 1u);  // cut off
  EXPECT_TRUE(parsed("<U4", "(0,)", "").texts.empty());
}

TEST(Npz, FloatsServeAsIntegersAndWhatIsNoNumberIsNone) {
  const IntegerMatrix read =
      parsed("<f4", "(3,)", array_bytes(std::vector<float>{7, 2.5f, NAN})).integers(1, "x");
  EXPECT_EQ(read(0, 0), 7);
  EXPECT_EQ(read(1, 0), 2);
  EXPECT_EQ(read(2, 0), -1);
}

TEST(Npz, NumbersOfTheOtherByteOrderAndOfHalfPrecisionAreRead) {
  EXPECT_EQ(parsed(">f4", "(1,)", std::string("\x3f\xc0\0\0", 4)).values[0], 1.5f);
  EXPECT_EQ(parsed(">i2", "(1,)", std::string("\x01\x02", 2)).whole[0], 258);
  EXPECT_EQ(parsed("<f2", "(2,)", std::string("\0\x3e\0\x7c", 4)).values,
            (std::vector<float>{1.5f, INFINITY}));
  EXPECT_EQ(parsed("|b1", "(2,)", std::string("\0\1", 2)).whole, (std::vector<int64_t>{0, 1}));
}

TEST(Npz, OtherNumberTypesAreRefused) {
  EXPECT_THROW(parsed("<c8", "(1,)", std::string(8, '\0')), Error);
}

}  // namespace
}  // namespace understudy
