// The extension module _whit: the library's functions as the Python package `whit` calls them.
// They run without the GIL, with progress and Control-C, and raise errors as whit.Error.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <sys/types.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "library/whit.h"
#include "python/view.h"

namespace whit::python {

namespace py = pybind11;

namespace {

// Raises errors of the library as whit.Error.
void translate(std::exception_ptr thrown) {  // NOLINT(performance-unnecessary-value-param)
  try {
    std::rethrow_exception(thrown);
  } catch (const api::Error& error) {
    // A text is empty if the library does not know it, which Python expresses by None.
    const auto orNone = [](const std::string& text) -> py::object {
      if (text.empty()) return py::none();
      return py::str(text);
    };

    const py::object make = py::module_::import("whit._error").attr("of_library");
    const py::object raised = make(error.what(), error.status(), orNone(error.file()),
                                   orNone(error.place()), orNone(error.expected()));
    PyErr_SetObject(py::type::handle_of(raised).ptr(), raised.ptr());
  }
}

// A running call, constructed and destroyed with the GIL held. The interpreter waits for running
// calls before it exits: a daemon thread that returned to Python later would be terminated inside
// C++ code, which aborts the process.
class Call {
 public:
  Call() {
    sleepAtTheEnd();
    ++underWay;
  }
  ~Call() {
    --underWay;
    sleepAtTheEnd();
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  // True if the work of this thread must end.
  static bool mustEnd() { return ending && std::this_thread::get_id() != ender; }

  // Ends all calls that report progress. `atexit` calls it.
  static void endAll() {
    constexpr std::chrono::milliseconds kStep{1};
    constexpr int kSteps = 10000;
    ender = std::this_thread::get_id();
    ending = true;

    // Calls on other threads need the GIL to return.
    const py::gil_scoped_release noGil;
    for (int i = 0; i < kSteps && underWay > 0; ++i) std::this_thread::sleep_for(kStep);
  }

  // Forgets the calls of other threads, which a forked child does not have.
  static void forgetOthers() { underWay = 0; }

 private:
  static void sleepAtTheEnd() {
    if (!mustEnd()) return;
    const py::gil_scoped_release noGil;
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  }

  static inline std::atomic<int> underWay{0};
  static inline std::atomic<bool> ending{false};
  static inline std::thread::id ender;  // written before `ending`
};

// Receives the progress of a call. On the calling thread it handles Python's signals and calls the
// caller's progress function now and then.
class ProgressRelay {
 public:
  explicit ProgressRelay(py::object function) : function_(std::move(function)) {}

  bool operator()(const std::string& phase, double fraction) {
    constexpr std::chrono::milliseconds kBetween{20};  // each call acquires the GIL
    // The result false ends the work.
    if (Call::mustEnd()) return false;

    const Clock::time_point now = Clock::now();
    if (std::this_thread::get_id() != thread_ || now - last_ < kBetween) return true;
    last_ = now;

    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (function_.is_none()) return true;
    const py::object answer = function_(phase, fraction);
    return answer.is_none() || answer.cast<bool>();
  }

 private:
  using Clock = std::chrono::steady_clock;

  py::object function_;
  std::thread::id thread_ = std::this_thread::get_id();
  Clock::time_point last_ = Clock::now();
};

// Calls `body` without the GIL, with a progress to report to, and returns its result.
template <typename Body>
auto call(const py::object& function, Body&& body) {
  const Call running;
  ProgressRelay relay(function);
  const py::gil_scoped_release noGil;
  return body(std::ref(relay));
}

using Floats = py::array_t<float, py::array::c_style>;
using Indices = py::array_t<std::uint32_t, py::array::c_style>;

// Keeps an object alive for the library, which releases it without holding the GIL.
std::shared_ptr<const void> kept(const py::object& object) {
  return {new py::object(object), [](const py::object* held) {
            const py::gil_scoped_acquire gil;
            delete held;
          }};
}

template <typename Array>
auto spanOf(const Array& array) {
  return std::span(array.data(), static_cast<std::size_t>(array.size()));
}

// The arrays of a whit.Mesh, in the order of Mesh._arrays(). They are read in place.
api::MeshArrays meshOf(const py::tuple& arrays) {
  const auto triangles = arrays[1].cast<Indices>();
  const auto positions = arrays[0].cast<Floats>();
  const auto normals = arrays[2].cast<Floats>();
  const auto uvs = arrays[3].cast<Floats>();
  const auto colors = arrays[4].cast<Floats>();

  return {spanOf(positions), spanOf(triangles), spanOf(normals),
          spanOf(uvs),       spanOf(colors),    kept(arrays)};
}

struct Picture {
  api::Image image;
  api::FrameStatistics statistics;
  std::optional<api::Receipt> receipt;
};

// A scene with its renderer. Threads take turns at it.
class Session {
 public:
  explicit Session(api::Scene scene) : renderer_(std::move(scene)) {}
  ~Session() {
    if (isLost()) new api::Renderer(std::move(renderer_));  // leaks what the other thread left
  }

  // Calls the question with the renderer, with the GIL.
  template <typename Question>
  auto ask(const Question& question) {
    const Lock lock(*this);
    return question(renderer_);
  }

  // Calls the question with the renderer, without the GIL.
  template <typename Question>
  auto trace(const py::object& progress, const Question& question) {
    const Lock lock(*this);
    return call(progress, [&](const api::Progress& reporter) {
      renderer_.setProgress(reporter);
      return question(renderer_);
    });
  }

  // The options and the camera hold for this frame only. With `pathSeconds` the camera is on the
  // camera path.
  Picture render(const OptionTexts& options, std::optional<double> pathSeconds,
                 const py::object& progress, const std::string& camera,
                 const std::pair<std::string, std::string>& within) {
    return trace(progress, [&](api::Renderer& renderer) {
      takeOptions(options);
      renderer.lookThrough(camera);

      Picture picture;
      if (within != std::pair<std::string, std::string>()) {
        picture.receipt = renderer.renderWithin(within.first, within.second, picture.image);
      } else if (pathSeconds) {
        renderer.renderOnPath(*pathSeconds, picture.image);
      } else {
        renderer.render(picture.image);
      }
      picture.statistics = renderer.statistics();
      return picture;
    });
  }

  void setMember(const std::string& pointer, const std::string& json, const py::object& progress) {
    trace(progress, [&](api::Renderer& renderer) { renderer.setMember(pointer, json); });
  }

  void updateMesh(const std::string& name, const py::tuple& arrays, const py::object& progress) {
    const api::MeshArrays mesh = meshOf(arrays);
    trace(progress, [&](api::Renderer& renderer) { renderer.updateMesh(name, mesh); });
  }

  void setTime(double seconds) {
    ask([&](api::Renderer& renderer) { renderer.setTime(seconds); });
  }

  void setTransform(const std::string& pointer, const std::array<double, 12>& rows) {
    ask([&](api::Renderer& renderer) { renderer.setTransform(pointer, rows); });
  }

#ifdef WHIT_SERVE
  std::unique_ptr<View> view(const OptionTexts& options, int port) {
    return trace(py::none(), [&](api::Renderer& renderer) {
      return std::make_unique<View>(renderer, options, port);
    });
  }
#endif

 private:
  // Waits until other threads are done. Python's lock handles signals meanwhile.
  class Lock {
   public:
    explicit Lock(Session& session) : session_(session) {
      constexpr int kUsage = 2;
      // A progress function runs while its thread has the lock, so waiting here would never end.
      if (session.owner_ == std::this_thread::get_id()) {
        throw api::Error(kUsage, "the scene is in use: a progress function cannot ask it anything");
      }
      if (session.isLost()) {
        throw api::Error(kUsage,
                         "another thread used the scene when this process was forked: make a new "
                         "scene here, or fork while no thread uses it");
      }

      session.process_ = getpid();
      session.lock_.attr("acquire")();
      session.owner_ = std::this_thread::get_id();
    }
    ~Lock() {
      session_.owner_ = std::thread::id();
      Py_XDECREF(PyObject_CallMethod(session_.lock_.ptr(), "release", nullptr));
    }
    Lock(const Lock&) = delete;
    Lock& operator=(const Lock&) = delete;

   private:
    Session& session_;
  };

  // True in a forked child if a thread that it does not have was using the scene.
  bool isLost() const { return process_ != getpid() && owner_ != std::thread::id(); }

  void takeOptions(const OptionTexts& options) {
    if (options == options_) return;

    // If an option is refused, the options of the renderer are unknown, and the next frame sets
    // them again.
    options_.reset();
    renderer_.reset();
    for (const auto& [name, value] : options) renderer_.set(name, value);
    options_ = options;
  }

  api::Renderer renderer_;
  std::optional<OptionTexts> options_ = OptionTexts();  // the renderer's; none after an error
  py::object lock_ = py::module_::import("threading").attr("Lock")();
  std::atomic<std::thread::id> owner_;  // the thread that has the lock
  pid_t process_ = getpid();            // the process that used the scene last
};

template <typename T>
py::array_t<T> arrayOf(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

api::LoadOptions loadOptions(const py::dict& given) {
  const auto take = [&](const char* name, auto& member) {
    const py::object value = given[name];
    try {
      member = value.cast<std::decay_t<decltype(member)>>();
    } catch (const py::cast_error&) {
      // The message of pybind11 would not name the option.
      throw py::type_error(std::string(name) + ": cannot take " +
                           py::repr(value).cast<std::string>());
    }
  };

  api::LoadOptions options;
  take("allow_outside", options.allowOutside);
  take("strict", options.strict);
  take("max_memory_gb", options.maxMemoryGb);
  take("threads", options.threads);
  take("sky", options.sky);
  take("sphere_segments", options.sphereSegments);
  take("moves", options.moves);
  take("movable", options.movable);
  take("animation", options.animation);
  take("settings", options.settings);
  return options;
}

std::unique_ptr<Session> load(const std::string& name, const py::dict& given,
                              const std::string& shippedScenes, const py::object& progress) {
  api::LoadOptions options = loadOptions(given);
  return std::make_unique<Session>(call(progress, [&](const api::Progress& reporter) {
    options.progress = reporter;
    return api::loadScene(name, options, shippedScenes.c_str());
  }));
}

api::SceneBuilder builderOf(const std::string& name, const std::string& description,
                            const py::dict& meshes, const py::dict& images) {
  api::SceneBuilder builder(name, description);
  for (const auto& [key, value] : meshes) {
    builder.addMesh(key.cast<std::string>(), meshOf(value.cast<py::tuple>()));
  }

  for (const auto& [key, value] : images) {
    const auto array = value.cast<py::array>();
    api::ImageArrays image{static_cast<int>(array.shape(1)), static_cast<int>(array.shape(0)),
                           static_cast<int>(array.shape(2))};

    const std::size_t count = array.size();
    // 8-bit codes are sRGB, floats are linear values.
    if (py::isinstance<py::array_t<std::uint8_t>>(array)) {
      image.codes = {static_cast<const std::uint8_t*>(array.data()), count};
    } else {
      image.values = {static_cast<const float*>(array.data()), count};
    }
    image.keep = kept(array);
    builder.addTexture(key.cast<std::string>(), std::move(image));
  }
  return builder;
}

std::unique_ptr<Session> build(const std::string& name, const std::string& description,
                               const py::dict& meshes, const py::dict& images,
                               const py::dict& given, const py::object& progress) {
  const api::SceneBuilder builder = builderOf(name, description, meshes, images);
  api::LoadOptions options = loadOptions(given);
  return std::make_unique<Session>(call(progress, [&](const api::Progress& reporter) {
    options.progress = reporter;
    return builder.build(options);
  }));
}

// A view of the picture's memory, which the view keeps alive. DLPack exports no read-only arrays.
template <typename T>
py::array viewOf(const py::object& picture, std::span<const T> data, std::size_t components) {
  const api::Image& image = picture.cast<const Picture&>().image;
  return py::array_t<T>({static_cast<std::size_t>(image.height()),
                         static_cast<std::size_t>(image.width()), components},
                        data.data(), picture);
}

// Maps each channel's name to the names of its components and its values.
py::dict channelsOf(const py::object& picture) {
  py::dict all;
  for (const auto& channel : picture.cast<const Picture&>().image.channels()) {
    py::list components;
    for (const std::string_view name : channel.components) components.append(std::string(name));

    const std::size_t count = channel.components.size();
    const py::array values = channel.numbers.empty() ? viewOf(picture, channel.values, count)
                                                     : viewOf(picture, channel.numbers, count);
    all[py::str(std::string(channel.name))] = py::make_tuple(components, values);
  }
  return all;
}

py::dict describe(const api::Receipt& r) {
  using namespace py::literals;
  return py::dict("chosen"_a = py::dict(py::cast(r.chosen)), "choose_ms"_a = r.chooseMs,
                  "expected_ms"_a = r.expectedMs, "picture_ms"_a = r.pictureMs, "error"_a = r.error,
                  "error_low"_a = r.errorLow, "error_high"_a = r.errorHigh, "note"_a = r.note,
                  "text"_a = r.text);
}

py::dict describe(const api::FrameStatistics& frame) {
  py::dict stages, rays;
  for (const auto& stage : frame.stages) stages[py::str(std::string(stage.name))] = stage.ms;
  for (const auto& kind : frame.rays) rays[py::str(std::string(kind.name))] = kind.count;

  py::dict all;
  all["frame_ms"] = frame.frameMs;
  all["embree_ms"] = frame.embreeMs;
  all["stages_ms"] = stages;
  all["rays"] = rays;
  all["non_finite_pixels"] = frame.nonFinitePixels;
  all["limited_pixels"] = frame.limitedPixels;
  return all;
}

py::list optionTable() {
  py::list table;
  for (const api::OptionInfo& option : api::options()) {
    table.append(py::make_tuple(std::string(option.name), std::string(option.words),
                                std::string(option.help), option.preset));
  }
  return table;
}

std::map<std::string, double> animationsOf(Session& session) {
  return session.ask([](const api::Renderer& renderer) {
    std::map<std::string, double> all;
    for (const api::Animation& a : renderer.scene().animations()) all[a.name] = a.seconds;
    return all;
  });
}

// Returns the numbers of an array, which must be of float32 or float64 and C-contiguous.
api::Numbers numbersOf(const py::array& array) {
  const std::size_t count = array.size();
  if (array.dtype().is(py::dtype::of<float>())) {
    return {{static_cast<const float*>(array.data()), count}, {}};
  }
  return {{}, {static_cast<const double*>(array.data()), count}};
}

py::dict describe(const api::RayHits& hits) {
  const py::capsule owner(new std::shared_ptr<void>(hits.memory),
                          [](void* held) { delete static_cast<std::shared_ptr<void>*>(held); });

  py::dict columns;
  const auto put = [&](const char* name, auto span) {
    using Element = typename decltype(span)::element_type;
    columns[name] = py::array_t<Element>(static_cast<py::ssize_t>(span.size()), span.data(), owner);
  };

  put("t", hits.t);
  put("t_error", hits.tError);
  put("point", hits.points);
  put("geometric_normal", hits.geometricNormals);
  put("shading_normal", hits.shadingNormals);
  put("weights", hits.weights);
  put("uv", hits.uvs);
  put("triangle", hits.triangles);
  put("object", hits.objects);
  put("material", hits.materials);
  put("instance", hits.instances);
  put("side", hits.sides);
  put("certain", hits.certain);

  if (!hits.offsets.empty()) columns["offsets"] = arrayOf(hits.offsets);
  return columns;
}

py::tuple describe(const api::RayAnswers& answers) {
  return py::make_tuple(arrayOf(answers.yes), arrayOf(answers.certain));
}

py::array describe(const std::vector<float>& values) { return arrayOf(values); }

// Defines a function that asks the renderer a question about arrays, and more.
template <typename... More, typename Question>
void defineQuery(py::class_<Session>& session, const char* name, Question question) {
  session.def(name, [question](Session& s, const std::vector<py::array>& arrays, More... more,
                               const py::object& progress) {
    std::vector<api::Numbers> numbers;
    for (const py::array& array : arrays) numbers.push_back(numbersOf(array));

    return describe(
        s.trace(progress, [&](api::Renderer& r) { return question(r, numbers, more...); }));
  });
}

void defineQueries(py::class_<Session>& session) {
  using Given = std::vector<api::Numbers>;
  const auto raysOf = [](const Given& n) { return api::Rays{n[0], n[1], n[2], n[3]}; };

  defineQuery(session, "closest", [=](auto& r, const Given& n) { return r.closest(raysOf(n)); });
  defineQuery(session, "occluded", [=](auto& r, const Given& n) { return r.occluded(raysOf(n)); });
  defineQuery<std::size_t>(session, "all_hits", [=](auto& r, const Given& n, std::size_t limit) {
    return r.allHits(raysOf(n), limit);
  });

  defineQuery(session, "visible",
              [](auto& r, const Given& n) { return r.visible(n[0], n[1], n[2], n[3]); });
  defineQuery<double, int>(session, "ambient_occlusion",
                           [](auto& r, const Given& n, double radius, int samples) {
                             return r.ambientOcclusion(n[0], n[1], radius, samples);
                           });
}

#ifdef WHIT_SERVE
void defineView(py::module_& module, py::class_<Session>& session) {
  using NoGil = py::call_guard<py::gil_scoped_release>;
  py::class_<View>(module, "View")
      .def_property_readonly("url", &View::url)
      .def("png",
           [](const View& view) {
             return py::bytes(call(py::none(), [&](const api::Progress&) { return view.png(); }));
           })
      .def("close", &View::close, NoGil());

  session.def("view", &Session::view);
}
#endif

void defineSession(py::module_& module) {
  // Queries a scene while no other thread uses it.
  const auto getter = [](auto member) {
    return [member](Session& session) {
      return session.ask([&](const api::Renderer& r) { return (r.scene().*member)(); });
    };
  };

  py::class_<Session> session(module, "Session");
  defineQueries(session);

  session.def_property_readonly("name", getter(&api::Scene::name))
      .def_property_readonly("width", getter(&api::Scene::width))
      .def_property_readonly("height", getter(&api::Scene::height))
      .def_property_readonly("cameras", getter(&api::Scene::cameras))
      .def_property_readonly("objects", getter(&api::Scene::objects))
      .def_property_readonly("materials", getter(&api::Scene::materials))
      .def_property_readonly("triangles", getter(&api::Scene::triangles))
      .def_property_readonly("warnings", getter(&api::Scene::warnings))
      .def_property_readonly("settings", getter(&api::Scene::settings))
      .def_property_readonly("path_seconds", getter(&api::Scene::pathSeconds))
      .def_property_readonly("animations", &animationsOf)
      .def("camera",
           [](Session& session, const std::string& name) {
             return session.ask([&](const api::Renderer& r) { return r.scene().camera(name); });
           })
      .def("option",
           [](Session& session, const std::string& name) {
             return session.ask([&](const api::Renderer& r) { return r.get(name); });
           })
      .def("render", &Session::render)
      .def("set_member", &Session::setMember)
      .def("set_time", &Session::setTime)
      .def("set_transform", &Session::setTransform)
      .def("update_mesh", &Session::updateMesh);
#ifdef WHIT_SERVE
  defineView(module, session);
#endif
}

void definePicture(py::module_& module) {
  py::class_<Picture>(module, "Picture")
      .def_property_readonly("width", [](const Picture& p) { return p.image.width(); })
      .def_property_readonly("height", [](const Picture& p) { return p.image.height(); })
      .def_property_readonly("left", [](const Picture& p) { return p.image.left(); })
      .def_property_readonly("top", [](const Picture& p) { return p.image.top(); })
      .def_property_readonly("rgb",
                             [](const py::object& picture) {
                               return viewOf(picture, picture.cast<const Picture&>().image.rgb(),
                                             3);
                             })
      .def_property_readonly("rgba",
                             [](const py::object& picture) {
                               return viewOf(picture, picture.cast<const Picture&>().image.srgb(),
                                             4);
                             })
      .def_property_readonly("channels", &channelsOf)
      .def_property_readonly("statistics",
                             [](const Picture& p) {
                               py::dict all = describe(p.statistics);
                               if (p.receipt) all["receipt"] = describe(*p.receipt);
                               return all;
                             })
      .def("write",
           [](const Picture& p, const std::string& path) {
             call(py::none(), [&](const api::Progress&) { p.image.write(path); });
           })
      .def(
          "png",
          [](const Picture& p) {
            return py::bytes(call(py::none(), [&](const api::Progress&) { return p.image.png(); }));
          })
      .def("bytes", [](const Picture& p) { return py::bytes(p.image.bytes()); });

  module.def("picture", [](const py::bytes& bytes) {
    return Picture{api::Image::fromBytes(std::string_view(bytes)), {}, {}};
  });
}

}  // namespace

}  // namespace whit::python

PYBIND11_MODULE(_whit, module) {
  using namespace whit::python;
  pybind11::register_exception_translator(&translate);

  defineSession(module);
  definePicture(module);

  module.def("load", &load);
  module.def("build", &build);
  module.def("option_table", &optionTable);
  module.def("version", &whit::api::version);

  // At the exit of the interpreter running calls end, and a forked child forgets those of its
  // parent.
  pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function(&Call::endAll));
  pybind11::module_::import("os").attr("register_at_fork")(
      pybind11::arg("after_in_child") = pybind11::cpp_function(&Call::forgetOthers));
}
