// The kernels, for one instruction set: included where kLanes, the floats of a register, and kRows, the rows
// whose sums the registers hold, are defined. Nothing here may be shared by two of them.
namespace understudy::nn {
namespace {

typedef float Lanes __attribute__((vector_size(4 * kLanes)));
typedef int IntLanes __attribute__((vector_size(4 * kLanes)));
typedef Lanes LooseLanes __attribute__((aligned(4), may_alias));
typedef IntLanes LooseIntLanes __attribute__((aligned(4), may_alias));
constexpr int kStep = 2 * kLanes;  // columns computed together
static_assert(kPanel % kStep == 0, "a panel is some steps");

inline Lanes load(const float* from) {
  return *reinterpret_cast<const LooseLanes*>(from);
}
inline void store(float* to, Lanes x) {
  *reinterpret_cast<LooseLanes*>(to) = x;
}
inline Lanes all(float x) {
  return x - Lanes{};
}
/// The second where one of them is no number: the one that may be.
inline Lanes larger(Lanes a, Lanes b) {
  return a > b ? a : b;
}
inline float sum(Lanes x) {
  float s = 0;
  for (int i = 0; i < kLanes; ++i) s += x[i];
  return s;
}

/// Which of the inner places some row of the block is not 0 at.
int nonzero_places(const Product& p, const float* a, int rows, unsigned short* places) {
  int any[kMostInner];
  const int whole = p.inner / kLanes * kLanes;
  for (int k = 0; k < whole; k += kLanes) {
    IntLanes some{};
    for (int r = 0; r < rows; ++r) some |= load(a + r * p.a_stride + k) != Lanes{};
    *reinterpret_cast<LooseIntLanes*>(any + k) = some;
  }
  for (int k = whole; k < p.inner; ++k) any[k] = 1;
  int count = 0;
  for (int k = 0; k < p.inner; ++k) {
    places[count] = static_cast<unsigned short>(k);
    count += any[k] != 0;
  }
  return count;
}

/// Rows that are multiplied together.
struct Block {
  const Product& p;
  const float* a;
  float* c;
  const unsigned short* places;  // of the inner places, those where not all rows are 0; null: all of them
  int count;
};

/// R rows times kStep columns of b: in registers from the first to the last inner place.
template <int R, bool kListed>
void multiply_columns(const Block& block, const float* b, int column) {
  const Product& p = block.p;
  const Lanes none{};
  Lanes left[R], right[R];
#pragma GCC unroll 8
  for (int r = 0; r < R; ++r) {
    left[r] = p.bias ? load(p.bias + column) : none;
    right[r] = p.bias ? load(p.bias + column + kLanes) : none;
  }
  for (int i = 0; i < block.count; ++i) {
    const std::ptrdiff_t k = kListed ? block.places[i] : i;
    const Lanes b0 = load(b + k * p.b_stride), b1 = load(b + k * p.b_stride + kLanes);
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) {
      const Lanes x = all(block.a[r * p.a_stride + k]);
      left[r] += x * b0;
      right[r] += x * b1;
    }
  }
  float* const c = block.c + column;
#pragma GCC unroll 8
  for (int r = 0; r < R; ++r) {
    float* const to = p.finish == Finish::Max ? c : c + r * p.c_stride;
    if (p.finish == Finish::Relu) {
      left[r] = larger(none, left[r]);
      right[r] = larger(none, right[r]);
    } else if (p.finish == Finish::Add) {
      left[r] += load(to);
      right[r] += load(to + kLanes);
    } else if (p.finish == Finish::Max) {
      left[r] = larger(load(to), left[r]);
      right[r] = larger(load(to + kLanes), right[r]);
    }
    store(to, left[r]);
    store(to + kLanes, right[r]);
  }
}

/// Fetches what is needed next, a little at a time.
class Fetcher {
 public:
  explicit Fetcher(const Product& p) : at_(p.ahead), end_(p.ahead + p.ahead_size) {
    const std::ptrdiff_t blocks = (p.rows + kRows - 1) / kRows * p.panels * kSteps;
    slice_ = ((p.ahead_size + kLine - 1) / kLine + blocks - 1) / blocks * kLine;
  }
  void fetch() {
    const float* const to = end_ - at_ < slice_ ? end_ : at_ + slice_;
    for (; at_ < to; at_ += kLine) __builtin_prefetch(at_, 0, 2);
  }

 private:
  static constexpr int kLine = 16, kSteps = kPanel / kStep;
  const float *at_, *end_;
  std::ptrdiff_t slice_;
};

template <int R>
void multiply_block(const Block& block, Fetcher& fetcher) {
  const Product& p = block.p;
  for (int panel = 0; panel < p.panels; ++panel)
    for (int step = 0; step < kPanel; step += kStep) {
      const float* const b = p.b + panel * p.panel_stride + step;
      fetcher.fetch();
      if (block.places)
        multiply_columns<R, true>(block, b, panel * kPanel + step);
      else
        multiply_columns<R, false>(block, b, panel * kPanel + step);
    }
}

template <int R>
void multiply_some(const Block& block, int rows, Fetcher& fetcher) {
  if (rows == R) return multiply_block<R>(block, fetcher);
  if constexpr (R > 1) multiply_some<R - 1>(block, rows, fetcher);
}

void multiply(const Product& p) {
  unsigned short places[kMostInner];
  Fetcher fetcher(p);
  for (int row = 0; row < p.rows; row += kRows) {
    const int rows = p.rows - row < kRows ? p.rows - row : kRows;
    Block block{p, p.a + row * p.a_stride, p.finish == Finish::Max ? p.c : p.c + row * p.c_stride, nullptr,
                p.inner};
    if (p.sparse) {
      block.places = places;
      block.count = nonzero_places(p, block.a, rows, places);
    }
    multiply_some<kRows>(block, rows, fetcher);
  }
}

void layer_norm(const LayerNormed& n) {
  constexpr float kLeast = 1e-5f;  // LibTorch's
  for (int row = 0; row < n.rows; ++row) {
    const float* const x = n.x + row * n.width;
    float* const out = n.out + row * n.width;
    Lanes total{};
    for (int i = 0; i < n.width; i += kLanes) total += load(x + i);
    const Lanes mean = all(sum(total) / static_cast<float>(n.width));
    Lanes square{};
    for (int i = 0; i < n.width; i += kLanes) square += (load(x + i) - mean) * (load(x + i) - mean);
    const float variance = sum(square) / static_cast<float>(n.width);
    const Lanes scale = all(1 / __builtin_sqrtf(variance + kLeast));
    for (int i = 0; i < n.width; i += kLanes) {
      Lanes y = (load(x + i) - mean) * scale * load(n.gain + i) + load(n.shift + i);
      if (n.add) y += load(n.add + row * n.width + i);
      store(out + i, y);
    }
  }
}

/// exp of what is not above 0: 2^n times a polynomial of the rest (Cephes' expf), good to two units in the
/// last place. Below -87 it stays at exp(-87); what is no number stays so.
inline Lanes exp_of(Lanes x) {
  x = larger(all(-87.0f), x);
  constexpr float kRound = 12582912.0f;  // 1.5 * 2^23: what is added to it loses its fraction
  const Lanes n = (x * 1.44269504f + kRound) - kRound;
  const Lanes r = x - n * 0.693359375f + n * 2.12194440e-4f;
  Lanes y = r * 1.9875691500e-4f + 1.3981999507e-3f;
  y = y * r + 8.3334519073e-3f;
  y = y * r + 4.1665795894e-2f;
  y = y * r + 1.6666665459e-1f;
  y = y * r + 5.0000001201e-1f;
  y = y * r * r + r + 1.0f;
  const IntLanes power = (__builtin_convertvector(n, IntLanes) + 127) << 23;
  return y * reinterpret_cast<Lanes>(power);
}

void softmax(const Softmaxed& s) {
  constexpr float kNever = -1e30f;
  for (int row = 0; row < s.rows; ++row) {
    float* const score = s.scores + row * s.stride;
    const float* const squared = s.squared ? s.squared + row * s.squared_stride : nullptr;
    for (int i = s.count; i < s.stride; ++i) score[i] = kNever;
    Lanes most = all(kNever);
    for (int i = 0; i < s.stride; i += kLanes) {
      Lanes x = load(score + i);
      if (squared) x -= s.factor * load(squared + i);
      most = larger(most, x);
      store(score + i, x);
    }
    float top = most[0];
    for (int i = 1; i < kLanes; ++i) top = most[i] > top ? most[i] : top;
    Lanes total{};
    for (int i = 0; i < s.stride; i += kLanes) {
      const Lanes e = exp_of(load(score + i) - top);
      total += e;
      store(score + i, e);
    }
    const Lanes scale = all(1 / sum(total));
    for (int i = 0; i < s.stride; i += kLanes) store(score + i, load(score + i) * scale);
    for (int i = s.count; i < s.stride; ++i) score[i] = 0;
  }
}

void silu(float* x, std::ptrdiff_t count) {
  for (std::ptrdiff_t i = 0; i < count; i += kLanes) {
    const Lanes v = load(x + i), e = exp_of(v < Lanes{} ? v : -v);
    store(x + i, v * (v < Lanes{} ? e : all(1.0f)) / (1.0f + e));
  }
}

}  // namespace
}  // namespace understudy::nn
