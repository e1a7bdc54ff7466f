// No class of the window grows without end; the counter, on classes whose methods are known.
#include "architecture/class_sizes.h"
#include "architecture/project_files.h"

namespace patina::architecture {
namespace {

constexpr int kMostMethods = 30;

// "Name 3 Other 0".
std::string sizesOf(const std::string& text) {
  std::string words;
  for (const ClassSize& one : classesIn(text))
    words += (words.empty() ? "" : " ") + one.name + " " + std::to_string(one.methods);
  return words;
}

TEST(ClassSizes, NoClassOfTheWindowHasMoreMethodsThanOneCanHold) {
  std::size_t classes = 0;
  for (const SourceFile& file : filesUnder({"app/gui"}, isCode))
    for (const ClassSize& one : classesIn(file.text)) {
      ++classes;
      EXPECT_LE(one.methods, kMostMethods)
          << file.path << ":" << one.line << ": " << one.name << " has " << one.methods
          << " methods: it holds more than one idea";
    }
  EXPECT_GT(classes, 100u);
}

TEST(ClassSizes, OverloadsOperatorsAndConstructorsAreMethods) {
  EXPECT_EQ(sizesOf(R"(class A {
 public:
  A();
  explicit(true) A(int a) : Base<int>(a), a_{f(a)}, b_(g({1, 2})) {}
  A(const A&) = delete;
  A& operator=(A&& other) noexcept(noexcept(f())) = default;
  virtual ~A();
  void set(int a);
  void set(double a);
  bool operator()(int a) const { return a < 3; }
  bool operator<(const A& other) const;
  A& operator<<(int a);
  auto operator<=>(const A&) const = default;
  explicit operator bool() const { return true; }
  [[nodiscard("it is new")]] std::vector<std::pair<int, A>> all() const&;
  auto last() const -> std::map<int, void (*)(int)>;
  template <class T, class = std::enable_if_t<(sizeof(T) > 2)>> void each(const T& call);
  virtual void draw(QPainter& painter = standard()) = 0;
  static constexpr double kTwice(double x) { return 2 * x; }
};)"),
            "A 17");
}

TEST(ClassSizes, SignalsAndPrivateMethodsCountMacrosDoNot) {
  EXPECT_EQ(sizesOf(R"(class A : public QWidget, private B<C(int)> {
  Q_OBJECT
  Q_PROPERTY(int x READ x)
 public slots:
  void take();
 signals:
  void changed();
  void said(const Message& message);

 protected:
  bool event(QEvent* event) override;

 private:
  void draw() const;
};)"),
            "A 5");
}

TEST(ClassSizes, WhatABodyCallsIsNoMethod) {
  EXPECT_EQ(sizesOf(R"(struct A final {
  int first() const {
    if (const int n = count(); n > 0) return at(0);
    const auto inner = [this](int i) { return at(i); };
    return inner(1);
  } // ; void no();
  /* void nor() { */ bool second() const { return text() == "void neither(); {" && c != '{'; }
#define LINES \
  void no();
  int third(char c) { return c == '\'' ? 1'000 : 2; }
};)"),
            "A 3");
}

TEST(ClassSizes, DataFriendsAndAliasesAreNoMethods) {
  EXPECT_EQ(sizesOf(R"(class A {
  friend class B;
  friend void swap(A& a, A& b) { a.swap(b); }
  using Deliver = std::function<void(bool last)>;
  typedef int (*Old)(int);
  static_assert(sizeof(int) == 4);
  enum class Kind { gap, doubt };
  class Later;
  std::function<void(int)> call_;
  std::function<int(int)> twice_ = [](int a) { return f(a); };
  void (*plain_)(int) = nullptr;
  void (B::*of_b_)(int);
  int (&row_)[3];
  alignas(16) double x_ = f(1);
  decltype(f(1)) y_{g(2), 3};
  std::array<int, (3 > 2)> z_;
  Widget *a_ = new Widget(this), *b_ = new Widget(this);
  static const char* const kText = R"x(void no() {})x";
  int bits_ : 3;
};)"),
            "A 0");
}

TEST(ClassSizes, EachClassCountsForItselfWhereverItIs) {
  EXPECT_EQ(sizesOf(R"(namespace n {
class Outside;
enum class Kind : int { a };
template <class T> struct Outer {
  void one();
  struct Inner {
    void two();
    void three();
    struct Empty {};
  } inner_{make()};
  class [[nodiscard]] Other : public Inner { int x() { return f(); } };
  void four();
};
template <> struct Outer<int> {};
void Named::Way::f() {
  struct stat about;
  struct Local { int g(); };
  struct { int h() { return 1; } } nameless;
}
class A::B final : C {
  B();
};
})"),
            "Outer 2 Inner 2 Empty 0 Other 1 Outer 0 Local 1  1 B 1");
  EXPECT_EQ(classesIn("// first\n#include <a>\n\nstruct A {\n  void f();\n};\n").at(0).line, 4);
}

} // namespace
} // namespace patina::architecture
