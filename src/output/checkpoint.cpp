// Checkpoints: HDF5, a dataset an array, numbers as attributes of the root group, and after what HDF5 reads a seal over
// the bytes of the file. HDF5 never meets a full disk or a damaged file, which leave the library in an undefined state:
// it builds the file in memory for AtomicFile to write, and it opens a file only once the seal was found whole.
#include <map>
#include <utility>

#include <fmt/format.h>
#include <hdf5.h>

#include "output/checkpoint_fields.hpp"
#include "output/files.hpp"

namespace grainray {

namespace {

/// An HDF5 call failed; caught in this file and turned into a sentence about the checkpoint.
struct Hdf5Failure {
    const char* what;
};

void check(herr_t status, const char* what) {
    if (status < 0) throw Hdf5Failure{what};
}

/// Owns an HDF5 identifier.
class Handle {
public:
    Handle(hid_t id, herr_t (*close)(hid_t), const char* what) : id_(id), close_(close) {
        if (id < 0) throw Hdf5Failure{what};
    }
    ~Handle() {
        if (id_ >= 0) close_(id_);
    }
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
    Handle& operator=(Handle&&) = delete;
    operator hid_t() const { return id_; }

private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// HDF5 prints its error stack unless told not to.
class Silence {
public:
    Silence() {
        H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~Silence() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

private:
    H5E_auto2_t function_ = nullptr;
    void* data_ = nullptr;
};

/// Type of a component and number of components; in memory and on disk (files are little endian).
template <class T>
struct Layout;
template <class T>
struct Layout<Vec3<T>> {
    static constexpr hsize_t components = 3;
    static hid_t type() { return Layout<T>::type(); }
};
#define GR_LAYOUT(T, TYPE)                        \
    template <>                                   \
    struct Layout<T> {                            \
        static constexpr hsize_t components = 1;  \
        static hid_t type() { return TYPE; }      \
    }
GR_LAYOUT(float, H5T_IEEE_F32LE);
GR_LAYOUT(double, H5T_IEEE_F64LE);
GR_LAYOUT(std::int32_t, H5T_STD_I32LE);
GR_LAYOUT(std::int64_t, H5T_STD_I64LE);
GR_LAYOUT(std::uint32_t, H5T_STD_U32LE);
GR_LAYOUT(std::uint64_t, H5T_STD_U64LE);
#undef GR_LAYOUT

/// UTF-8 of a fixed length; one byte more because HDF5 knows no string of length 0.
Handle string_type(std::size_t length) {
    Handle type(H5Tcreate(H5T_STRING, length + 1), H5Tclose, "string type");
    check(H5Tset_cset(type, H5T_CSET_UTF8), "string type");
    return type;
}

/// The last bytes of a checkpoint. A file without one (repacked by an HDF5 tool) is judged by its payload alone.
struct Seal {
    char mark[8] = {'g', 'r', 'a', 'i', 'n', 'r', 'a', 'y'};
    std::uint64_t checksum = 0;
};

Seal seal_of(std::string_view bytes) {
    Checksum sum;
    sum.add(bytes.data(), bytes.size());
    Seal seal;
    seal.checksum = sum.value();
    return seal;
}

bool has_broken_seal(std::string_view file) {
    Seal seal;
    if (file.size() < sizeof seal) return false;
    const std::string_view bytes = file.substr(0, file.size() - sizeof seal);
    std::memcpy(&seal, file.data() + bytes.size(), sizeof seal);
    const Seal whole = seal_of(bytes);
    return std::memcmp(seal.mark, whole.mark, sizeof seal.mark) == 0 && seal.checksum != whole.checksum;
}

// ---- writing

template <class T>
void put_number(hid_t file, const char* name, const T& value) {
    const hsize_t size = Layout<T>::components;
    Handle space(size == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, nullptr), H5Sclose, name);
    Handle attribute(H5Acreate2(file, name, Layout<T>::type(), space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, name);
    check(H5Awrite(attribute, Layout<T>::type(), &value), name);
}

template <class T>
void put_array(hid_t file, const char* name, const std::vector<T>& array) {
    const hsize_t size[2] = {array.size(), Layout<T>::components};
    Handle space(H5Screate_simple(size[1] == 1 ? 1 : 2, size, nullptr), H5Sclose, name);
    Handle set(H5Dcreate2(file, name, Layout<T>::type(), space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose, name);
    if (!array.empty()) check(H5Dwrite(set, Layout<T>::type(), H5S_ALL, H5S_ALL, H5P_DEFAULT, array.data()), name);
}

void put_format(hid_t file) {
    const std::string text = checkpoint_format;
    Handle type = string_type(text.size());
    Handle space(H5Screate(H5S_SCALAR), H5Sclose, "format");
    Handle attribute(H5Acreate2(file, "format", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "format");
    check(H5Awrite(attribute, type, text.c_str()), "format");
}

void put_scene(hid_t file, const std::string& text) {
    Handle type = string_type(text.size());
    Handle space(H5Screate(H5S_SCALAR), H5Sclose, "scene");
    Handle set(H5Dcreate2(file, "scene", type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose, "scene");
    check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), "scene");
}

/// The file as HDF5 1.8 or later reads it, all metadata checksummed, in memory only.
Handle memory_file() {
    Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file access");
    check(H5Pset_fapl_core(access, std::size_t{64} << 20, false), "memory file");
    check(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18), "file version");
    return Handle(H5Fcreate("checkpoint", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "memory file");
}

void fill(hid_t file, const Checkpoint& c) {
    put_format(file);
    put_number(file, "version", checkpoint_version);
    put_number(file, "checksum", checksum_of(c));
    for_each_number(c, [&](const char* name, const auto& value) { put_number(file, name, value); });
    for_each_array(c, [&](const char* name, const auto& array, int) { put_array(file, name, array); });
    put_scene(file, c.scene);
}

// ---- reading

template <class T>
void get_number(hid_t file, const char* name, T& value) {
    Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose, name);
    Handle space(H5Aget_space(attribute), H5Sclose, name);
    if (H5Sget_simple_extent_npoints(space) != Layout<T>::components) throw Hdf5Failure{name};
    check(H5Aread(attribute, Layout<T>::type(), &value), name);
}

template <class T>
void get_array(hid_t file, const char* name, std::vector<T>& array) {
    Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, name);
    Handle space(H5Dget_space(set), H5Sclose, name);
    hsize_t size[2] = {0, 1}, file_size = 0;
    const int rank = Layout<T>::components == 1 ? 1 : 2;
    if (H5Sget_simple_extent_ndims(space) != rank) throw Hdf5Failure{name};
    check(H5Sget_simple_extent_dims(space, size, nullptr), name);
    check(H5Fget_filesize(file, &file_size), name);
    if (size[1] != Layout<T>::components || size[0] > file_size / sizeof(T)) throw Hdf5Failure{name};
    array.resize(size[0]);
    if (size[0] > 0) check(H5Dread(set, Layout<T>::type(), H5S_ALL, H5S_ALL, H5P_DEFAULT, array.data()), name);
}

void get_scene(hid_t file, std::string& text) {
    Handle set(H5Dopen2(file, "scene", H5P_DEFAULT), H5Dclose, "scene");
    Handle type(H5Dget_type(set), H5Tclose, "scene");
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) throw Hdf5Failure{"scene"};
    text.resize(H5Tget_size(type));
    check(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "scene");
    text.pop_back();  // the byte more
}

bool has_format(hid_t file) {
    const htri_t exists = H5Aexists(file, "format");
    check(exists, "format");
    if (exists == 0) return false;
    Handle attribute(H5Aopen(file, "format", H5P_DEFAULT), H5Aclose, "format");
    Handle type(H5Aget_type(attribute), H5Tclose, "format");
    if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) return false;
    std::string text(H5Tget_size(type), '\0');
    check(H5Aread(attribute, type, text.data()), "format");
    return text.c_str() == std::string_view(checkpoint_format);
}

Handle open_file(const std::filesystem::path& path) {
    if (H5Fis_hdf5(path.c_str()) <= 0) throw_read_error(path, "it is not an HDF5 file, so not a grainray checkpoint");
    if (has_broken_seal(read_text(path))) throw Hdf5Failure{"seal"};
    Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "file access");
    check(H5Pset_file_locking(access, false, true), "file access");  // many network file systems have no locks
    return Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose, "the file");
}

Checkpoint read_all(const std::filesystem::path& path) {
    Handle file = open_file(path);
    if (!has_format(file)) throw_read_error(path, "it is an HDF5 file but not a grainray checkpoint");
    std::uint32_t version = 0;
    get_number(file, "version", version);
    if (version != checkpoint_version)
        throw_read_error(path, fmt::format("it is a checkpoint of format version {}, this program reads version {}", version, checkpoint_version));
    Checkpoint c;
    std::uint64_t checksum = 0;
    get_number(file, "checksum", checksum);
    for_each_number(c, [&](const char* name, auto& value) { get_number(file, name, value); });
    std::map<int, std::size_t> length;  // of each group
    for_each_array(c, [&](const char* name, auto& array, int group) {
        get_array(file, name, array);
        if (length.emplace(group, array.size()).first->second != array.size()) throw Hdf5Failure{name};
    });
    get_scene(file, c.scene);
    if (checksum != checksum_of(c)) throw Hdf5Failure{"checksum"};
    return c;
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& c) {
    const Silence silence;
    try {
        Handle file = memory_file();
        fill(file, c);
        check(H5Fflush(file, H5F_SCOPE_GLOBAL), "flush");
        void** memory = nullptr;  // the memory driver's file handle is the address of its buffer
        check(H5Fget_vfd_handle(file, H5P_DEFAULT, reinterpret_cast<void**>(&memory)), "memory file");
        const ssize_t size = H5Fget_file_image(file, nullptr, 0);  // the buffer itself is larger
        check(size < 0 ? -1 : 0, "memory file");
        const std::string_view bytes(static_cast<const char*>(*memory), static_cast<std::size_t>(size));
        const Seal seal = seal_of(bytes);
        AtomicFile out(path);
        out.write(bytes);
        out.write({reinterpret_cast<const char*>(&seal), sizeof seal});
        out.commit();
    } catch (const Hdf5Failure& failure) {
        throw SimulationError(fmt::format("cannot write {}: HDF5 failed at '{}', most likely out of memory", path.string(), failure.what));
    }
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
    check_readable(path);
    const Silence silence;
    try {
        return read_all(path);
    } catch (const Hdf5Failure& failure) {
        throw_read_error(path, fmt::format("the checkpoint is damaged or cut short (at '{}'); use an older one", failure.what));
    }
}

}  // namespace grainray
