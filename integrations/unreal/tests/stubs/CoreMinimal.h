// SPDX-License-Identifier: MIT
// What the plugin uses of Unreal Engine, as far as a test without it needs that: names and signatures of its public
// documentation, and the least behavior.
#pragma once

#include <cstdint>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#define MIENFACE_API
#define MIENFACEEDITOR_API
#define UCLASS(...)
#define USTRUCT(...)
#define UPROPERTY(...)
#define UFUNCTION(...)
#define GENERATED_BODY()
#define TEXT(text) text
#define TCHAR_TO_UTF8(text) (text)
#define UTF8_TO_TCHAR(text) (text)
#define DEFINE_LOG_CATEGORY_STATIC(name, level, compiled)
#define UE_LOG(category, level, ...) (std::printf(__VA_ARGS__), std::printf("\n"), ++logged_errors)
inline int logged_errors = 0;

using int32 = int32_t;
enum { INDEX_NONE = -1 };

struct FString {
  std::string text;
  FString(const char* from = "") : text(from) {}
  static FString ConstructFromPtrSize(const char* from, int32 size) {
    FString made;
    made.text.assign(from, static_cast<size_t>(size));
    return made;
  }
  bool EndsWith(const char* end) const {
    const std::string part(end);
    return text.size() >= part.size() &&
           text.compare(text.size() - part.size(), part.size(), part) == 0;
  }
  const char* operator*() const { return text.c_str(); }
};

inline bool operator<(const FString& a, const FString& b) { return a.text < b.text; }

template <class T>
using TSharedPtr = std::shared_ptr<T>;
template <class T>
TSharedPtr<T> MakeShared() {
  return std::make_shared<T>();
}
template <class T>
struct TWeakPtr {
  std::weak_ptr<T> pointer;
  TWeakPtr() = default;
  TWeakPtr(const TSharedPtr<T>& from) : pointer(from) {}
  TSharedPtr<T> Pin() const { return pointer.lock(); }
};
template <class K, class V>
struct TMap {
  std::map<K, V> items;
  const V* Find(const K& key) const {
    const auto found = items.find(key);
    return found == items.end() ? nullptr : &found->second;
  }
  void Add(const K& key, const V& value) { items[key] = value; }
};

struct FName {
  std::string text;
  FName() = default;
  explicit FName(const FString& from) : text(from.text) {}
  bool operator<(const FName& other) const { return text < other.text; }
};
inline const FName NAME_None;

template <class T>
struct TArray {
  std::vector<T> items;
  int32 Num() const { return static_cast<int32>(items.size()); }
  void SetNum(int32 count) { items.resize(static_cast<size_t>(count)); }
  int32 Add(const T& item) {
    items.push_back(item);
    return Num() - 1;
  }
  T* GetData() { return items.data(); }
  T& operator[](int32 index) { return items.at(static_cast<size_t>(index)); }
  const T& operator[](int32 index) const { return items.at(static_cast<size_t>(index)); }
};

struct FVector {
  double X = 0, Y = 0, Z = 0;
  FVector() = default;
  FVector(double x, double y, double z) : X(x), Y(y), Z(z) {}
};
struct FQuat {
  double X = 0, Y = 0, Z = 0, W = 1;
  FQuat() = default;
  FQuat(double x, double y, double z, double w) : X(x), Y(y), Z(z), W(w) {}
};
struct FTransform {
  FQuat Rotation;
  FVector Translation, Scale3D{1, 1, 1};
  FTransform() = default;
  FTransform(const FQuat& r, const FVector& t, const FVector& s)
      : Rotation(r), Translation(t), Scale3D(s) {}
};

/// Objects of the engine, and pointers that know whether theirs is gone.
struct UObject {
  const std::shared_ptr<bool> Lives = std::make_shared<bool>(true);
  virtual ~UObject() = default;
};
template <class T>
struct TWeakObjectPtr {
  T* Object = nullptr;
  std::weak_ptr<bool> Lives;
  TWeakObjectPtr& operator=(T* object) {
    Object = object;
    Lives = object ? object->Lives : std::weak_ptr<bool>();
    return *this;
  }
  T* Get() const { return Lives.expired() ? nullptr : Object; }
};

using FCriticalSection = std::mutex;
struct FScopeLock {
  std::lock_guard<std::mutex> guard;
  explicit FScopeLock(FCriticalSection* lock) : guard(*lock) {}
};
