// Films read back as pictures, frame by frame, in the order in which they are shown: whatever the libavformat
// of the machine knows (.mp4, .mkv, .webm, .y4m, .gif, ...), and folders of numbered pictures,
// "dir/%05d.png". How colours are converted stands in video/rgb.h.
//
// Local files only: no name is taken for an address, and no play list leads away from the disk. Frames are
// not rotated by the metadata of the film; one whose size changes in its course is refused, and so is one
// that is damaged: nothing is concealed. Only a Matroska film that was cut off passes for a shorter one.
#pragma once
#include <memory>
#include <string>

#include "image/image.h"

namespace smokebox {

class FilmReader {
 public:
  /// Throws IoError with the name of the file and the reason: it is not there, it is no film, a numbered
  /// picture is missing in between.
  explicit FilmReader(const std::string& file);
  ~FilmReader();
  FilmReader(const FilmReader&) = delete;
  FilmReader& operator=(const FilmReader&) = delete;

  int width() const;
  int height() const;
  /// Frames a second on the average; 0 if there is no such thing, as for a folder of pictures.
  double fps() const;
  /// The next frame; false at the end. Throws IoError if the film is damaged there.
  bool next(Image& image);
  /// How many frames have been read.
  long count() const;

 private:
  struct Film;
  class FilmFile;
  class FilmFolder;
  std::unique_ptr<Film> film_;
};

}  // namespace smokebox
