/* Whole numbers kept beside files and data sets. */
#include "checkpoint_internal.h"

bool bw_checkpoint__put_attribute(hid_t object, const char *name, uint64_t value)
{
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute =
      H5Acreate2(object, name, H5T_NATIVE_UINT64, space, H5P_DEFAULT, H5P_DEFAULT);
  bool ok = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_UINT64, &value) >= 0;
  if (attribute >= 0) ok = H5Aclose(attribute) >= 0 && ok;
  if (space >= 0) H5Sclose(space);
  return ok;
}

/* The attribute is one number of that very type, or reading is refused. */
bool bw_checkpoint__get_attribute(hid_t object, const char *name, uint64_t *value)
{
  if (H5Aexists(object, name) <= 0) return false;
  const hid_t attribute = H5Aopen(object, name, H5P_DEFAULT);
  if (attribute < 0) return false;
  const hid_t space = H5Aget_space(attribute), type = H5Aget_type(attribute);
  /* A damaged file may hold anything under this name: its shape is looked at before it is read. */
  const bool ok = space >= 0 && type >= 0 && H5Sget_simple_extent_npoints(space) == 1 &&
                  H5Tequal(type, H5T_NATIVE_UINT64) > 0 &&
                  H5Aread(attribute, H5T_NATIVE_UINT64, value) >= 0;
  if (type >= 0) H5Tclose(type);
  if (space >= 0) H5Sclose(space);
  H5Aclose(attribute);
  return ok;
}
