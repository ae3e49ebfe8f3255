// What is drawn over the picture: outlines of planes, the colour bar or the list of kinds, the caption.
#pragma once

#include <string>

#include "render/canvas.hpp"
#include "render/paint.hpp"
#include "render/panels.hpp"
#include "render/trace.hpp"
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

/// Rims and creases of meshes that are not cut away, where nothing solid stands before them.
void draw_edges(Canvas&, const View&, const std::vector<Skin>& meshes, const std::optional<Cut>&);
/// A round length along the near lower edge of the block, with its label. `unit`: of letters, as unit_of().
void draw_scale_bar(Canvas&, const View&, const Relief&, float unit);

/// "t = 12.0 s, 20,160 particles (12 beyond the ground shown)"
std::string caption(double time, std::size_t particles, std::size_t beyond);

}  // namespace grainray::picture
