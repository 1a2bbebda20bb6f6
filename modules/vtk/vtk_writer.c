/* The frame all data sets share: header, appended blocks, closing lines. */
#include "vtk_internal.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

static const char closing[] = "\n  </AppendedData>\n</VTKFile>\n";

const bw_vtk__kind *bw_vtk__kind_of(bw_vtk_type type)
{
  static const bw_vtk__kind kinds[] = {
      [BW_VTK_FLOAT32] = {"Float32", 4}, [BW_VTK_FLOAT64] = {"Float64", 8},
      [BW_VTK_INT32] = {"Int32", 4},     [BW_VTK_INT64] = {"Int64", 8},
      [BW_VTK_UINT8] = {"UInt8", 1},
  };
  const size_t index = (size_t)type;
  return index < sizeof kinds / sizeof *kinds ? &kinds[index] : NULL;
}

static const char *byte_order(void)
{
  const uint16_t one = 1;
  unsigned char first;
  memcpy(&first, &one, 1);
  return first == 1 ? "LittleEndian" : "BigEndian";
}

void bw_vtk__begin(bw_vtk__text *text, const char *type)
{
  bw_vtk__add(text,
              "<?xml version=\"1.0\"?>\n"
              "<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"%s\" header_type=\"UInt64\">\n",
              type, byte_order());
}

void bw_vtk__end(bw_vtk__text *text, const char *type)
{
  /* The underscore marks where the offsets count from. */
  bw_vtk__add(text, "  </%s>\n  <AppendedData encoding=\"raw\">\n_", type);
}

void bw_vtk__time(bw_vtk__text *text, double time)
{
  /* In the text: one number needs no block. */
  if (isfinite(time))
    bw_vtk__add(text,
                "    <FieldData>\n      <DataArray type=\"Float64\" Name=\"TimeValue\" "
                "NumberOfTuples=\"1\" format=\"ascii\">%.17g</DataArray>\n    </FieldData>\n",
                time);
}

void bw_vtk__declare(bw_vtk__writer *writer, bw_vtk__text *text, const char *name, bw_vtk_type type,
                     int components, uint64_t values)
{
  const bw_vtk__kind *kind = bw_vtk__kind_of(type);
  bw_vtk__add(text, "        <DataArray type=\"%s\" Name=\"", kind->name);
  bw_vtk__add_escaped(text, name);
  bw_vtk__add(text, "\" NumberOfComponents=\"%d\" format=\"appended\" offset=\"%" PRIu64 "\"/>\n",
              components, writer->declared);
  /* The next array begins behind this one's length and values. */
  writer->declared += sizeof(uint64_t) + values * kind->bytes;
}

bw_status bw_vtk__open(bw_vtk__writer *writer, const char *path, const bw_vtk__text *text)
{
  BW_TRY(bw_comm_agree(writer->comm, text->status));
  BW_TRY(bw_file_create(writer->comm, path, &writer->file));
  const bool first = bw_comm_rank(writer->comm) == 0;
  /* All ranks hold the same head, so that all know where the first block begins. */
  writer->place = (int64_t)text->used;
  return bw_file_write_at_all(writer->file, 0, first ? text->used : 0, text->chars);
}

bw_status bw_vtk__block(bw_vtk__writer *writer, uint64_t bytes, int64_t *start)
{
  const bool first = bw_comm_rank(writer->comm) == 0;
  const int64_t head = writer->place;
  *start = head + (int64_t)sizeof bytes;
  writer->place = *start + (int64_t)bytes;
  /* The first rank writes the length; the values are written by whoever has them. */
  return bw_file_write_at_all(writer->file, head, first ? sizeof bytes : 0, &bytes);
}

bw_status bw_vtk__close(bw_vtk__writer *writer, bw_status so_far)
{
  if (writer->file == NULL) return so_far;
  const bool first = bw_comm_rank(writer->comm) == 0;
  BW_THEN(so_far, bw_file_write_at_all(writer->file, writer->place, first ? sizeof closing - 1 : 0,
                                       closing));
  /* Only a file that all ranks have written to the end gets its name. */
  if (so_far == BW_OK) return bw_file_close(&writer->file);
  bw_file_abandon(&writer->file);
  return so_far;
}
