// SPDX-FileCopyrightText: Copyright (c) SteerableNoise contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * What a filter has found out about the datasets of its input, kept from one execution to the next
 * (private to this module).
 */
#ifndef KeptByInput_h
#define KeptByInput_h

#include "vtkDataObject.h"

#include <map>
#include <utility>
#include <vector>

namespace noise
{
/// `Known`: what is found out. `Key`: what it depends on beside the dataset; compared with ==.
template <class Known, class Key>
class KeptByInput
{
public:
  /**
   * Gives each block (`Source`, a dataset; `Known`, a pointer) what is known of its source if neither
   * its modification time nor keyOf(block) has changed, else a new one, and drops what no block asks
   * for.
   */
  template <class Block, class KeyOf>
  void Assign(std::vector<Block>& blocks, KeyOf&& keyOf)
  {
    std::map<const vtkDataObject*, Entry> before;
    before.swap(this->Entries);
    for (Block& block : blocks)
    {
      Entry& now = this->Entries[block.Source];
      const auto known = before.find(block.Source);
      if (known != before.end())
      {
        now = std::move(known->second);
        before.erase(known);
      }
      const vtkMTimeType time = block.Source->GetMTime();
      const Key key = keyOf(block);
      if (now.Time != time || !(now.Dependence == key))
      {
        now = Entry{ time, key, Known() };
      }
      block.Known = &now.What;
    }
  }

  void Clear() { this->Entries.clear(); }

private:
  struct Entry
  {
    vtkMTimeType Time = 0;
    Key Dependence{};
    Known What;
  };
  /// By datasets that are only compared: they may be gone.
  std::map<const vtkDataObject*, Entry> Entries;
};
} // namespace noise

#endif
