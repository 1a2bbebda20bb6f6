#include "particles_key.h"

int64_t bw_particles__cut_index(int64_t n, int left, int parts)
{
  /* n = q parts + r: floor(n left/parts) = q left + floor(r left/parts). */
  return n / parts * left + n % parts * left / parts;
}

bw_particles__selection bw_particles__select(int64_t cut, uint64_t least, uint64_t most)
{
  return (bw_particles__selection){.cut = cut, .low = least, .high = most + 1};
}

bool bw_particles__selected(const bw_particles__selection *s)
{
  return s->high - s->low == 1;
}

uint64_t bw_particles__pivot(const bw_particles__selection *s)
{
  return s->low + (s->high - s->low) / 2;
}

bool bw_particles__narrow(bw_particles__selection *s, int64_t below_pivot)
{
  const bool upper = below_pivot <= s->cut;
  if (upper) {
    s->low = bw_particles__pivot(s);
    s->below = below_pivot;
  } else {
    s->high = bw_particles__pivot(s);
  }
  return upper;
}
