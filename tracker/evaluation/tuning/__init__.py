"""Which parameters and which mounting explain the data best?"""
