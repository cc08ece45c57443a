// SPDX-License-Identifier: MIT
#pragma once
#define IMPLEMENT_MODULE(type, name)
