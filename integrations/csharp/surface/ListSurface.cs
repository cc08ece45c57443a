// SPDX-License-Identifier: MIT
// Prints the types and members of other assemblies that an assembly uses, one a line.
using System;
using System.Collections.Generic;
using System.Linq;
using System.Reflection;

static class ListSurface {
  // Tables of the metadata.
  const int TypeReferences = 0x01000000, MemberReferences = 0x0A000000;

  static IEnumerable<T> Rows<T>(int table, Func<int, T> resolve) {
    for (int row = 1;; ++row) {
      T item;
      try {
        item = resolve(table + row);
      } catch (ArgumentException) {
        yield break;  // behind the last row
      }
      yield return item;
    }
  }

  static string Name(Type type) {
    if (type.IsGenericType) type = type.GetGenericTypeDefinition();
    return type.FullName ?? type.Name;
  }

  static string Text(MemberInfo member) {
    string text = Name(member.DeclaringType) + "." + member.Name;
    if (!(member is MethodBase)) return text;
    return text + "(" + string.Join(", ", ((MethodBase)member).GetParameters().Select(p => Name(p.ParameterType))) + ")";
  }

  // A member of List<int> is listed as the one of List<T>.
  static MemberInfo Definition(MemberInfo member) {
    if (!member.DeclaringType.IsGenericType) return member;
    const BindingFlags all =
        BindingFlags.Public | BindingFlags.NonPublic | BindingFlags.Instance | BindingFlags.Static;
    Type type = member.DeclaringType.GetGenericTypeDefinition();
    return type.GetMembers(all).First(m => m.MetadataToken == member.MetadataToken);
  }

  static int Main(string[] arguments) {
    Module module = Assembly.LoadFrom(arguments[0]).ManifestModule;
    SortedSet<string> lines = new SortedSet<string>(StringComparer.Ordinal);
    foreach (Type type in Rows(TypeReferences, token => module.ResolveType(token))) lines.Add(Name(type));
    foreach (MemberInfo member in Rows(MemberReferences, token => module.ResolveMember(token))) {
      if (member.DeclaringType.Module != module) lines.Add(Text(Definition(member)));
    }
    foreach (string line in lines) Console.WriteLine(line);
    return 0;
  }
}
