// What is drawn over the picture: outlines of planes, the colour bar or the list of kinds, the caption.
#pragma once

#include <string>

#include "render/canvas.hpp"
#include "render/paint.hpp"
#include "render/panels.hpp"
#include "render/view.hpp"

namespace grainray::picture {

/// Pictures smaller than this carry no text: it could not be read.
bool has_text(int width, int height);

/// Free space for the legend and the caption.
Margins margins_for(const Paint&, int width, int height);

/// Edges of planes, thin, where nothing stands before them.
void draw_outlines(Canvas&, const View&, const Room&);

void draw_legend(Canvas&, const Paint&);
void draw_caption(Canvas&, const std::string& text);

/// "t = 12.0 s, 20,160 particles"
std::string caption(double time, std::size_t particles);

}  // namespace grainray::picture
