// SPDX-License-Identifier: MIT
// cairo's functions are loaded where they are first called (core/base/shared_library.hpp): it brings fonts and a window system with it.
#include "design/exports/png_writer.hpp"

#include <cairo-ft.h>
#include <ft2build.h>
#include FT_FREETYPE_H

#include <cmath>
#include <cstdint>
#include <memory>
#include <new>

#include "core/base/contract.hpp"
#include "core/base/shared_library.hpp"
#include "core/base/text.hpp"
#include "design/exports/picture_marks.hpp"

namespace fettle::design::exports {

namespace {

/// Each is called CAIRO(x) with its name, without its "cairo_".
// clang-format off
#define FETTLE_CAIRO_FUNCTIONS(CAIRO)                                                                                      \
    CAIRO(arc) CAIRO(clip) CAIRO(create) CAIRO(destroy) CAIRO(fill) CAIRO(font_face_destroy) CAIRO(font_face_set_user_data) \
    CAIRO(font_options_create) CAIRO(font_options_destroy) CAIRO(font_options_set_antialias)                                \
    CAIRO(font_options_set_hint_metrics) CAIRO(font_options_set_hint_style) CAIRO(ft_font_face_create_for_ft_face)          \
    CAIRO(image_surface_create) CAIRO(image_surface_get_data) CAIRO(image_surface_get_stride) CAIRO(line_to) CAIRO(move_to) \
    CAIRO(new_sub_path) CAIRO(paint) CAIRO(rectangle) CAIRO(restore) CAIRO(save) CAIRO(set_font_face)                       \
    CAIRO(set_font_options) CAIRO(set_font_size) CAIRO(set_line_cap) CAIRO(set_line_join) CAIRO(set_line_width)             \
    CAIRO(set_source_rgb) CAIRO(set_source_surface) CAIRO(status) CAIRO(stroke) CAIRO(stroke_preserve)                      \
    CAIRO(surface_destroy) CAIRO(surface_flush) CAIRO(surface_mark_dirty) CAIRO(surface_status)                             \
    CAIRO(surface_write_to_png_stream) CAIRO(text_path) CAIRO(toy_font_face_create) CAIRO(translate)
/// Functions of FreeType, which reads fonts and comes with cairo.
#define FETTLE_FREETYPE_FUNCTIONS(FREETYPE) FREETYPE(Done_FreeType) FREETYPE(Init_FreeType) FREETYPE(New_Face)
// clang-format on

struct CairoLibrary {
#define FETTLE_CAIRO_MEMBER(function) decltype(&cairo_##function) function;
#define FETTLE_FREETYPE_MEMBER(function) decltype(&FT_##function) function;
    FETTLE_CAIRO_FUNCTIONS(FETTLE_CAIRO_MEMBER)
    FETTLE_FREETYPE_FUNCTIONS(FETTLE_FREETYPE_MEMBER)
#undef FETTLE_FREETYPE_MEMBER
#undef FETTLE_CAIRO_MEMBER
};

CairoLibrary load_cairo() {
    CairoLibrary out{};
#ifdef FETTLE_CAIRO_NAME
    const core::base::SharedLibrary library(FETTLE_CAIRO_NAME, FETTLE_CAIRO_PATH);
#define FETTLE_CAIRO_FIND(function) library.find("cairo_" #function, out.function);
#define FETTLE_FREETYPE_FIND(function) library.find("FT_" #function, out.function);
#else
#define FETTLE_CAIRO_FIND(function) out.function = &cairo_##function;
#define FETTLE_FREETYPE_FIND(function) out.function = &FT_##function;
#endif
    FETTLE_CAIRO_FUNCTIONS(FETTLE_CAIRO_FIND)
    FETTLE_FREETYPE_FUNCTIONS(FETTLE_FREETYPE_FIND)
#undef FETTLE_FREETYPE_FIND
#undef FETTLE_CAIRO_FIND
    return out;
}

const CairoLibrary& cairo_library() {
    static const CairoLibrary library = load_cairo();
    return library;
}

void check(cairo_status_t status) {
    if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
    FETTLE_ASSERT(status == CAIRO_STATUS_SUCCESS, "cairo draws what a picture has");
}

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

Surface make_surface(int width, int height) {
    const CairoLibrary& cairo = cairo_library();
    Surface out{cairo.image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo.surface_destroy};
    check(cairo.surface_status(out.get()));
    return out;
}

Surface surface_of(const Image& image) {
    FETTLE_ASSERT(image.width > 0 && image.height > 0, "a picture without pixels");
    const CairoLibrary& cairo = cairo_library();
    Surface out = make_surface(image.width, image.height);
    cairo.surface_flush(out.get());
    unsigned char* bytes = cairo.image_surface_get_data(out.get());
    for (int y = 0; y < image.height; ++y, bytes += cairo.image_surface_get_stride(out.get())) {
        auto* words = reinterpret_cast<std::uint32_t*>(bytes);  // cairo's rows begin at multiples of four bytes
        for (int x = 0; x < image.width; ++x) {
            const Colour& c = image.at(x, y);
            words[x] = static_cast<std::uint32_t>(c[0] << 16 | c[1] << 8 | c[2]);
        }
    }
    cairo.surface_mark_dirty(out.get());
    return out;
}

cairo_status_t append(void* text, const unsigned char* bytes, unsigned int count) {
    try {
        static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(bytes), count);
    } catch (const std::bad_alloc&) {  // cairo is written in C
        return CAIRO_STATUS_NO_MEMORY;
    }
    return CAIRO_STATUS_SUCCESS;
}

std::string png_bytes(const Surface& surface) {
    std::string out;
    check(cairo_library().surface_write_to_png_stream(surface.get(), append, &out));
    return out;
}

using Font = std::unique_ptr<cairo_font_face_t, decltype(&cairo_font_face_destroy)>;

void close_font(void* library) { cairo_library().Done_FreeType(static_cast<FT_Library>(library)); }

// Null: there is none. cairo keeps fonts longer than their users do, so the file is closed when it drops the font.
cairo_font_face_t* opened_font(const std::string& file) {
    static const cairo_user_data_key_t key{};
    const CairoLibrary& cairo = cairo_library();
    FT_Library library = nullptr;  // one for each font: FreeType's must not open two at once
    if (cairo.Init_FreeType(&library) != 0) return nullptr;
    FT_Face face = nullptr;
    if (cairo.New_Face(library, file.c_str(), 0, &face) != 0) {
        cairo.Done_FreeType(library);
        return nullptr;
    }
    cairo_font_face_t* font = cairo.ft_font_face_create_for_ft_face(face, 0);
    check(cairo.font_face_set_user_data(font, &key, library, close_font));
    return font;
}

Font font_of(const std::string& folder, bool bold) {
    const CairoLibrary& cairo = cairo_library();
    cairo_font_face_t* font = opened_font(folder + (bold ? "/DejaVuSans-Bold.ttf" : "/DejaVuSans.ttf"));
    if (font == nullptr)
        font = cairo.toy_font_face_create("@cairo:", CAIRO_FONT_SLANT_NORMAL, bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    return {font, cairo.font_face_destroy};
}

/// A Canvas of picture_marks.hpp.
class CairoCanvas {
public:
    CairoCanvas(const Surface& surface, const std::string& fonts)
        : pen_{cairo_.create(surface.get()), cairo_.destroy}, plain_(font_of(fonts, false)), bold_(font_of(fonts, true)) {
        cairo_.set_line_cap(pen_.get(), CAIRO_LINE_CAP_ROUND);
        cairo_.set_line_join(pen_.get(), CAIRO_LINE_JOIN_ROUND);
        // Letters keep their shape: no machine's settings fit them to pixels.
        const std::unique_ptr<cairo_font_options_t, decltype(&cairo_font_options_destroy)> options{cairo_.font_options_create(),
                                                                                                   cairo_.font_options_destroy};
        cairo_.font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
        cairo_.font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
        cairo_.font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
        cairo_.set_font_options(pen_.get(), options.get());
    }

    void pixels(const Image& image) {
        const Surface surface = surface_of(image);
        cairo_.set_source_surface(pen_.get(), surface.get(), 0, 0);
        cairo_.paint(pen_.get());
    }

    void lines(const std::vector<PictureLine>& lines, const Colour& colour, double width) {
        for (const PictureLine& line : lines) {
            cairo_.move_to(pen_.get(), line.from.x(), line.from.y());
            cairo_.line_to(pen_.get(), line.to.x(), line.to.y());
        }
        ink(colour, width);
    }

    void circle(const Vector2& centre, double radius, const Colour& colour, double width) {
        cairo_.new_sub_path(pen_.get());
        cairo_.arc(pen_.get(), centre.x(), centre.y(), radius, 0, 2 * M_PI);
        ink(colour, width);
    }

    void box(const Vector2& corner, const Vector2& size, const Colour& colour, double width) {
        cairo_.rectangle(pen_.get(), corner.x(), corner.y(), size.x(), size.y());
        ink(colour, width);
    }

    void text(const Vector2& place, const std::string& words, const Colour& colour, const Letters& letters) {
        cairo_.set_font_face(pen_.get(), (letters.bold ? bold_ : plain_).get());
        cairo_.set_font_size(pen_.get(), letters.size);
        cairo_.move_to(pen_.get(), place.x(), place.y());
        cairo_.text_path(pen_.get(), core::base::shown_on_one_line(words).c_str());
        choose(white);
        cairo_.set_line_width(pen_.get(), letters.rim);
        cairo_.stroke_preserve(pen_.get());
        ink(colour, 0);
    }

    template <class Draw>
    void within(const Vector2& corner, const Vector2& size, const Draw& draw) {
        cairo_.save(pen_.get());
        cairo_.translate(pen_.get(), corner.x(), corner.y());
        cairo_.rectangle(pen_.get(), 0, 0, size.x(), size.y());
        cairo_.clip(pen_.get());
        draw();
        cairo_.restore(pen_.get());
    }

    template <class Draw>
    void group(const char*, const Draw& draw) {
        draw();
    }

    void finish() const { check(cairo_.status(pen_.get())); }

private:
    void choose(const Colour& colour) { cairo_.set_source_rgb(pen_.get(), colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0); }

    void ink(const Colour& colour, double width) {
        choose(colour);
        if (width > 0) {
            cairo_.set_line_width(pen_.get(), width);
            cairo_.stroke(pen_.get());
        } else {
            cairo_.fill(pen_.get());
        }
    }

    const CairoLibrary& cairo_ = cairo_library();
    std::unique_ptr<cairo_t, decltype(&cairo_destroy)> pen_;
    Font plain_, bold_;
};

}  // namespace

std::string png_bytes(const Image& image) { return png_bytes(surface_of(image)); }

std::string png_bytes(const Picture& picture, const std::string& fonts) {
    const Surface surface = make_surface(picture.surfaces.width, picture.surfaces.height);
    CairoCanvas canvas(surface, fonts);
    put_marks(picture, canvas);
    canvas.finish();
    return png_bytes(surface);
}

}  // namespace fettle::design::exports
